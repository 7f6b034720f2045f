#!/usr/bin/env bash
# The paper of docs/figures.md, from the files that docs.figures leaves: latex.sh KILN FOLDER. It compiles
# without a warning, and the figure in it has its width, its fonts and its words.
set -euo pipefail
kiln=$(realpath "$1")
cd "$2"
PATH=$(dirname "$kiln"):$PATH

fail() {
    echo "$*"
    exit 1
}
rm -f paper.pdf rates.pdf.d
kiln figure sheet torch.yaml --sweep systems.fire.emit.rate=20,60 --label 'Größe α' --label '≤ 10⁻³' \
    --width 84mm --size 480x270 --force -o rates.pdf
make -s paper.pdf >log.txt || fail "$(tail -n 30 log.txt)"
! grep -E 'Warning|Overfull|Error' paper.log || fail "pdflatex warns"
text=$(pdftotext -layout paper.pdf -)
for words in 'Größe α' '≤ 10⁻³' 'Figure 1: A torch' 'Figure 1 shows'; do
    [[ $text == *"$words"* ]] || fail "the document does not say '$words': $text"
done
[[ $(pdffonts paper.pdf | tail -n +3 | awk '{print $(NF-4)}' | sort -u) == yes ]] ||
    fail "a font is not embedded: $(pdffonts paper.pdf)"
# Labels are 8 points high: their boxes are those of the font, 146 + 40 of 140 parts of that.
pdftotext -bbox paper.pdf - | awk -F'"' '/>Größe</ { high = $8 - $4 }
    END { if (high < 10.5 || high > 10.8) { print "the label is " high " points high"; exit 1 } }'
# An image of 476 pixels at 300 an inch: it was not scaled.
[[ $(pdfimages -list paper.pdf | awk 'NR == 3 { print $4, $13, $14 }') == "476 300 300" ]] ||
    fail "the pictures were scaled: $(pdfimages -list paper.pdf)"
