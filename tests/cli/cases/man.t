The manual pages come from the tables of the program; docs.man has them checked by linters.

$ kiln help man | grep '^\.SH\|^\.SS'
1|.SH NAME
1|.SH SYNOPSIS
1|.SH DESCRIPTION
1|.SH COMMANDS
1|.SS kiln render [\fIOPTION...\fR] \fISCENE...\fR
1|.SS kiln bake [\fIOPTION...\fR] \fISCENE\fR
1|.SS kiln export [\fIOPTION...\fR] \fISCENE\fR
1|.SS kiln plan [\fIOPTION...\fR] \fISCENE\fR
1|.SS kiln join [\fIOPTION...\fR] \fIOUTPUT\fR
1|.SS kiln encode [\fIOPTION...\fR] \fIFRAMES\fR
1|.SS kiln compare [\fIOPTION...\fR] \fIREFERENCE TEST\fR
1|.SS kiln test [\fIOPTION...\fR] \fI[PATH | NAME]...\fR
1|.SS kiln test approve [\fIOPTION...\fR] \fI[PATH | NAME]...\fR
1|.SS kiln test calibrate [\fIOPTION...\fR] \fI[PATH | NAME]...\fR
1|.SS kiln test report [\fIOPTION...\fR] \fIFOLDER...\fR
1|.SS kiln test list [\fIOPTION...\fR] \fI[PATH | NAME]...\fR
1|.SS kiln figure [\fIOPTION...\fR]
1|.SS kiln figure sheet [\fIOPTION...\fR] \fISCENE...\fR
1|.SS kiln figure triptych [\fIOPTION...\fR] \fIREFERENCE TEST\fR
1|.SS kiln figure strip [\fIOPTION...\fR] \fISCENE | CLIP\fR
1|.SS kiln bench [\fIOPTION...\fR] \fI[SCENE | SUITE]...\fR
1|.SS kiln new [\fIOPTION...\fR] \fISCENE\fR
1|.SS kiln check [\fIOPTION...\fR] \fISCENE...\fR
1|.SS kiln params [\fIOPTION...\fR] \fISCENE\fR
1|.SS kiln devices [\fIOPTION...\fR]
1|.SS kiln help [\fIOPTION...\fR] \fI[TOPIC [KEY]]\fR
1|.SH OUTPUTS
1|.SH TEMPLATES
1|.SH TECHNIQUES
1|.SH METRICS
1|.SH TEST FILES
1|.SH REPORTS
1|.SH COMPLETION
1|.SH EXIT STATUS
1|.SH ENVIRONMENT
1|.SH FILES
1|.SH EXAMPLES
1|.SH SEE ALSO
$ kiln help man | grep -c '^\.TP'
1|381
$ kiln help man-scene | grep '^\.SH'
1|.SH NAME
1|.SH DESCRIPTION
1|.SH KEYS
1|.SH SEE ALSO
$ for page in man man-scene; do kiln help $page; done | grep -n '^[.'\'']' | grep -vE ':\.(TH|SH|SS|TP|PP|RS|RE|B|BR|br|nf|fi)( |$)'
= 1

Every option of every command is in it, and every key of a scene in kiln-scene(5).

$ kiln help | sed -n '/^commands/,/^$/s/^  \(.*[a-z]\)  .*/\1/p' | sed 's/   *.*//' | while read -r command; do
>     kiln help $command | grep -oE '^ +(-., )?--[a-z-]+' | grep -oE -- '--[a-z-]+'
> done | sort -u | while read -r option; do
>     kiln help man | sed 's/\\-/-/g' | grep -qF -- "$option" || echo "$option is missing"
> done
$ kiln help scene | grep -oE '^[a-z][A-Za-z_.]*( with.*)?$' >keys.txt
$ kiln help man-scene | sed -n '/^\.SH KEYS/,$s/^\\fB\(.*\)\\fR/\1/p' | diff keys.txt - && test -s keys.txt
