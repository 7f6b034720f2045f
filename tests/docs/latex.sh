#!/usr/bin/env bash
# Checks that a figure of kiln fits into a LaTeX document as docs/figures.md says: latex.sh KILN
# FOLDER. FOLDER has the document and the other files that the test docs.figures has made. The
# document must compile without a warning. The figure in it must have its width, embedded fonts,
# searchable words and labels of 8 points.
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
# Labels of 8 points have boxes 10.63 points high: 8 * (146 + 40) / 140, the ascent and descent of
# the font over its size (lib/figure/font.h).
pdftotext -bbox paper.pdf - | awk -F'"' '/>Größe</ { high = $8 - $4 }
    END { if (high < 10.5 || high > 10.8) { print "the label is " high " points high"; exit 1 } }'
# The pictures were not scaled if the first is 476 pixels wide, at 300 pixels an inch.
[[ $(pdfimages -list paper.pdf | awk 'NR == 3 { print $4, $13, $14 }') == "476 300 300" ]] ||
    fail "the pictures were scaled: $(pdfimages -list paper.pdf)"
