The manual page comes from the tables of the program, and roff has nothing to say against it.

$ kiln help man | grep '^\.SH\|^\.SS'
1|.SH NAME
1|.SH SYNOPSIS
1|.SH DESCRIPTION
1|.SH COMMANDS
1|.SS kiln render [\fIOPTION...\fR] \fISCENE...\fR
1|.SS kiln compare [\fIOPTION...\fR] \fIREFERENCE TEST\fR
1|.SS kiln test [\fIOPTION...\fR] \fI[PATH | NAME]...\fR
1|.SS kiln test approve [\fIOPTION...\fR] \fINAME...\fR
1|.SS kiln test calibrate [\fIOPTION...\fR] \fI[PATH | NAME]...\fR
1|.SS kiln test report [\fIOPTION...\fR] \fIFOLDER...\fR
1|.SS kiln test list [\fIOPTION...\fR] \fI[PATH | NAME]...\fR
1|.SS kiln figure [\fIOPTION...\fR] \fI\fR
1|.SS kiln figure sheet [\fIOPTION...\fR] \fISCENE...\fR
1|.SS kiln figure triptych [\fIOPTION...\fR] \fIREFERENCE TEST\fR
1|.SS kiln figure strip [\fIOPTION...\fR] \fISCENE | CLIP\fR
1|.SS kiln check [\fIOPTION...\fR] \fISCENE...\fR
1|.SS kiln devices [\fIOPTION...\fR] \fI\fR
1|.SS kiln help [\fIOPTION...\fR] \fI[TOPIC]\fR
1|.SH EXIT STATUS
1|.SH ENVIRONMENT
1|.SH EXAMPLES
1|.SH SEE ALSO
$ kiln help man | grep -c '^\.TP'
1|173
$ kiln help man | { if command -v groff >/dev/null; then groff -man -ww -z 2>&1; fi; }
$ kiln help man | grep -n '^[.'\'']' | grep -vE ':\.(TH|SH|SS|TP|PP|RS|RE|B)( |$)'
= 1

Every option of every command is in it.

$ for command in render compare test 'test approve' 'test calibrate' 'test report' 'test list' check devices help; do
>     kiln help $command | grep -oE '^ +(-., )?--[a-z-]+' | grep -oE -- '--[a-z-]+'
> done | sort -u | while read -r option; do
>     kiln help man | sed 's/\\-/-/g' | grep -qF -- "$option" || echo "$option is missing"
> done
