# Completes command lines of kiln in bash. `kiln complete` prints the possible continuations; this
# script fits them to the quotes and word breaks of the line that readline holds.
_kiln()
{
    # Splits the line into words as the shell does. readline replaces the last word from `start` on.
    local line=${COMP_LINE:0:COMP_POINT} words=() word='' quote='' in_word='' start=0 i c
    for ((i = 0; i < ${#line}; i++)); do
        c=${line:i:1}
        if [[ $quote && $c != "$quote" ]]; then
            word+=$c
        elif [[ $c == [\'\"] ]]; then
            if [[ $quote ]]; then quote=''; else quote=$c start=${#word} in_word=yes; fi
        elif [[ $c == [[:blank:]] ]]; then
            [[ $in_word ]] && words+=("$word")
            word='' in_word='' start=0
        elif [[ $c == "\\" ]]; then
            ((i++))
            word+=${line:i:1} in_word=yes
        else
            word+=$c in_word=yes
            [[ $COMP_WORDBREAKS == *"$c"* ]] && start=${#word}
        fi
    done

    COMPREPLY=() words=("${words[@]/#\~\//$HOME/}")
    if [[ ${words[-1]} =~ ^[0-9]*(\<|\>|\>\>|\>\|)$ ]]; then # a redirection takes any file
        compopt -o default
        return
    fi
    local kind text found
    while IFS=$'\t' read -r kind text _; do
        case $kind in
        part) compopt -o nospace ;;
        file:* | folder)
            compopt -o filenames
            mapfile -t found < <(
                word=${word#"$text"}
                [[ $kind == file:* ]] && compgen -f -X "!${kind#file:}" -- "$word"
                [[ $kind != 'file:*' ]] && compgen -d -- "$word"
            )
            COMPREPLY+=("${found[@]/#/"${text:start}"}")
            continue
            ;;
        esac
        text=${text:start}
        # Names come out of scenes and results of others, so they are quoted as the line needs it.
        case $quote in
        \') text=${text//\'/\'\\\'\'} ;;
        \")
            [[ $text == *!* ]] && continue # nothing quotes it between double quotes
            text=${text//\\/\\\\} text=${text//\"/\\\"} text=${text//\$/\\$} text=${text//\`/\\\`}
            ;;
        *)
            printf -v text %q "$text"
            text=${text//\\,/,} # a comma needs no quoting
            ;;
        esac
        COMPREPLY+=("$text")
    done < <("${words[0]}" complete -- "${words[@]:1}" "$word" 2>/dev/null)
}
complete -F _kiln kiln
