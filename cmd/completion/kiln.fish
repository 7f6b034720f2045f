# Completes command lines of kiln in fish. `kiln complete` prints the possible continuations; fish quotes the one that
# it takes.

# Prints the files and folders that begin with a path, after the text that stays before them. The pattern is for the
# names of files.
function __kiln_paths --argument-names before path pattern
    set -l start (string replace --regex '^~/' "$HOME/" -- $path)
    for found in $start*
        string match --quiet --regex '[[:cntrl:]]' -- $found
        and continue
        if test -d $found
            set found $found/
        else if not string match --quiet -- $pattern $found
            continue
        end
        # A path is printed as it was begun, or fish would not take it for a continuation.
        printf '%s%s\n' $before $path(string sub --start (math (string length -- $start) + 1) -- $found)
    end
end

function __kiln_complete
    set -l words (string replace --regex '^~/' "$HOME/" -- (commandline --current-process --tokenize --cut-at-cursor))
    set -l token (commandline --current-token --cut-at-cursor)
    # The token that is being typed may have an open quote, which string unescape does not know.
    set -l typed (string unescape -- $token; or string unescape -- "$token'"; or string unescape -- "$token\"")
    set -q typed[1]
    or set typed $token
    command $words[1] complete -- $words[2..] "$typed" 2>/dev/null | while read --local --delimiter \t kind text note
        switch $kind
            case 'file:*'
                __kiln_paths "$text" (string sub --start (math (string length -- "$text") + 1) -- "$typed") \
                    (string replace 'file:' '' -- $kind)
            case folder
                __kiln_paths "$text" (string sub --start (math (string length -- "$text") + 1) -- "$typed") ''
            case word part
                printf '%s\t%s\n' $text $note
        end
    end
end

complete --command kiln --no-files --keep-order --arguments '(__kiln_complete)'
