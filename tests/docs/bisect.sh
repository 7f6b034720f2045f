#!/usr/bin/env bash
# Checks that the recipe for `git bisect` in docs/testing.md finds the commit that changed a
# picture: bisect.sh KILN SOURCE. If this fails, a reader who follows the recipe finds a wrong
# commit. The scratch repository has commits that change nothing, one whose scene cannot be read,
# the one that changes the picture, and a later one that accepts the new picture.
set -euo pipefail
kiln=$(realpath "$1")
source=$(realpath "$2")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/bin"
ln -s "$kiln" "$work/bin/kiln"
export PATH=$work/bin:$PATH HOME=$work GIT_CONFIG_NOSYSTEM=1

recipe=$(sed -n '/^```sh bisect$/,/^```$/p' "$source/docs/testing.md" | sed '1d;$d')
[ -n "$recipe" ]

git init -q "$work/scenes"
cd "$work/scenes"
git config user.name tester
git config user.email tester@example.com
commit() {
    git add -A
    git commit -q -m "$1"
}
mkdir effects
cp "$source"/tests/cli/scenes/{tiny.yaml,puff.png} effects/
printf 'kiln_test: 1\nscene: tiny.yaml\nframes: [6]\nsize: [32, 18]\n' >effects/tiny.test.yaml
echo /out/ >.gitignore
kiln test --quiet effects --update missing
commit "accept it"
git tag v1.0
for i in 1 2 3; do
    echo "# $i" >>effects/tiny.yaml
    commit "say more $i"
done
cp effects/tiny.yaml good.yaml
echo 'systems: [' >>effects/tiny.yaml
commit "break it"
mv good.yaml effects/tiny.yaml
commit "mend it"
sed -i '3a set: [post.exposure=0.4]' effects/tiny.test.yaml
commit "make it brighter"
planted=$(git rev-parse HEAD)
echo '# 4' >>effects/tiny.yaml
commit "say more 4"
kiln test --quiet effects --update all
commit "accept that"
echo '# 5' >>effects/tiny.yaml
commit "say more 5"

printf '%s\n' "$recipe" >recipe.sh
echo /recipe.sh >>.git/info/exclude
said=$(bash recipe.sh 2>&1) || true
if ! grep -qxF "$planted is the first bad commit" <<<"$said" || [ -n "$(git status --short)" ]; then
    printf '%s\n' "$said"
    git status --short
    echo "expected: $planted"
    exit 1
fi
