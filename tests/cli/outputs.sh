#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Where pictures and reports go: several at once, standard output, links, targets that fail; nothing is damaged or left over.
. "$srcdir/tests/tap.sh"
. "$srcdir/tests/cli/run.sh"

module=
[ -f "$MCRENDER_MODULE_PATH/oiio.so" ] && module=1

# ---- what is written -----------------------------------------------------------------------------------------------------------------
run glow.scn --quiet -o a.ppm -o b.pfm -o plain --report r.json
equal "three pictures and a report" "$status $(listing)" "0 a.ppm b.pfm glow.scn plain r.json"
equal "their formats" "$(head -c 2 a.ppm) $(head -c 2 b.pfm) $(head -c 2 plain)" "P6 PF P6"
check "no extension is PPM" cmp a.ppm plain
equal "the size of a PPM" "$(($(wc -c <a.ppm)))" "$((11 + 8 * 8 * 3))"
run glow.scn --quiet -o -
check "-o - is a PPM on standard output" cmp "$TMPDIR/stdout" a.ppm
run glow.scn -o - --report -
check "-o - and --report - do not mix" test "$status" = 2 -a ! -s "$TMPDIR/stdout"
run glow.scn --quiet -o c.ppm --report -
check "--report - is JSON on standard output" grep -q '^  "mcrender": ' "$TMPDIR/stdout"
"$MCRENDER" glow.scn --quiet -o /dev/stdout >d.ppm
check "-o /dev/stdout" cmp d.ppm a.ppm
"$MCRENDER" glow.scn --quiet -o - | cat >d.ppm
check "-o - into a pipe" cmp d.ppm a.ppm
"$MCRENDER" - --quiet -o d.ppm <glow.scn
check "the scene from standard input" cmp d.ppm a.ppm
cat glow.scn | "$MCRENDER" --quiet -o - - >d.ppm
check "from a pipe to standard output" cmp d.ppm a.ppm
umask 022
run glow.scn --quiet -o new.ppm --report new.json
equal "permissions of new files" "$(stat -c %a new.ppm new.json | tr '\n' ' ')" "644 644 "
chmod 600 new.ppm
run glow.scn --quiet -o new.ppm
equal "permissions of a replaced file" "$(stat -c %a new.ppm)" 600

# ---- the default -----------------------------------------------------------------------------------------------------------------------
ending=ppm
[ -z "$module" ] || ending=exr
mkdir -p elsewhere/deep && cp glow.scn elsewhere/deep/two.dots.scn && cp glow.scn elsewhere/deep/bare
rm -f ./*.ppm ./*.pfm ./*.json plain
run glow.scn --quiet
equal "without -o" "$status $(listing)" "0 elsewhere glow.$ending glow.scn"
run elsewhere/deep/two.dots.scn --quiet
equal "without -o, in the current folder" "$status $(listing)" "0 elsewhere glow.$ending glow.scn two.dots.$ending"
run elsewhere/deep/bare --quiet
equal "without -o, a name without an extension" "$status $(ls bare.*)" "0 bare.$ending"
"$MCRENDER" --quiet - <glow.scn
equal "without -o, from standard input" "$? $(ls scene.*)" "0 scene.$ending"
equal "the folder of the scene stays as it was" "$(cd elsewhere/deep && listing)" "bare two.dots.scn"
MCRENDER_MODULE_PATH=/nonexistent "$MCRENDER" glow.scn --quiet
equal "without -o, without OpenImageIO's module" "$? $(head -c 2 glow.ppm)" "0 P6"
rm -rf elsewhere ./*.ppm ./*.exr

# ---- the same file twice --------------------------------------------------------------------------------------------------------------
run glow.scn --quiet -o kept.ppm
cp kept.ppm kept
ln -s kept.ppm link.ppm
mkdir sub
ln -s .. sub/up
twice() # what option... : refused, nothing is touched
{
    local what=$1
    shift
    run glow.scn --quiet --set glow=1 "$@"
    ends "twice: $what" 2 "are the same file"
    cmp -s kept.ppm kept && [ -L link.ppm ] || point 1 "twice: $what: nothing is touched"
}
twice "the same name" -o kept.ppm -o kept.ppm
twice "./" -o kept.ppm -o ./kept.ppm
twice "sub/.." -o kept.ppm -o sub/../kept.ppm
twice "an absolute path" -o kept.ppm -o "$PWD/kept.ppm"
twice "a link" -o kept.ppm -o link.ppm
twice "a link to a folder" -o sub/up/kept.ppm -o kept.ppm
twice "a new file" -o new.ppm -o ./new.ppm
twice "picture and report" -o kept.ppm --report kept.ppm
"$MCRENDER" glow.scn --quiet -o - -o /dev/stdout 2>"$TMPDIR/stderr" | cat >"$TMPDIR/stdout"
status=${PIPESTATUS[0]}
ends "twice: standard output" 2 "are the same file"
"$MCRENDER" glow.scn --quiet -o - -o out.ppm 2>"$TMPDIR/stderr" >out.ppm
status=$?
ends "twice: standard output leads to the file" 2 "are the same file"
rm -f out.ppm
run glow.scn --quiet -o /dev/null --report /dev/null
ends "/dev/null takes everything" 0
cp glow.scn scene.ppm
run scene.ppm --quiet -o scene.ppm
ends "the scene is no output" 2 "'scene.ppm' is the scene"
run scene.ppm --quiet -o other.ppm --report sub/../scene.ppm
ends "the scene is no report" 2 "is the scene"
check "the scene is untouched" cmp scene.ppm glow.scn
printf 'P6\n4 4\n255\n' >texels.ppm
head -c 48 /dev/zero | tr '\0' 'd' >>texels.ppm
cp texels.ppm texels
{ sed '/^sphere/d' glow.scn; echo 'texture t image { file "texels.ppm" }  material t lambert { albedo t }  sphere { center (0, 0, 0)   radius 1   material t }'
  echo 'light sky environment { image "sky.ppm" }  include "part.scn"'; } >reads.scn
cp texels.ppm sky.ppm
echo 'light p point { position (0, 5, 5)   intensity 1 }' >part.scn
cp part.scn part
run reads.scn --quiet -o other.ppm
ends "a scene that reads files" 0
for input in texels.ppm sky.ppm; do
    run reads.scn --quiet -o "sub/../$input"
    ends "a picture in the scene is no output: $input" 2 "'sub/../$input' is a picture in the scene"
    run reads.scn --quiet -o other.ppm --report "$input"
    ends "nor a report" 2 "'$input' is a picture in the scene"
done
run reads.scn --quiet -o other.ppm --report part.scn
ends "an included text is no report" 2 "'part.scn' is included by the scene"
run glow.scn --quiet --time 1 --spp 16 -o other.ppm --sample-map map.pfm
ends "a map" 0
run glow.scn --quiet --use-map map.pfm -o map.pfm
ends "the map to follow is no output" 2 "'map.pfm' is the map to follow"
run glow.scn --quiet --use-map map.pfm -o other.ppm --sample-map map.pfm
ends "nor another map" 2 "'map.pfm' is the map to follow"
check "what is read is untouched" eval 'cmp texels.ppm texels && cmp sky.ppm texels && cmp part.scn part'
ln kept.ppm hard.ppm
run glow.scn --quiet --set glow=1 -o hard.ppm -o kept.ppm
check "two names of one file become two files" cmp hard.ppm kept.ppm
equal "two names of one file" "$status $(stat -c %h kept.ppm)" "0 1"
run glow.scn --quiet -o link.ppm
cmp -s kept.ppm kept && [ -L link.ppm ]
point $? "a link is followed and stays"
rm -rf sub kept link.ppm hard.ppm scene.ppm other.ppm

# ---- targets that cannot be written ----------------------------------------------------------------------------------------------------
# fails WHAT TEXT OPTION...: status 1 at once (10^12 paths were asked for), nothing is made
fails()
{
    local what=$1 text=$2 before
    shift 2
    before=$(listing)
    timeout 60 "$MCRENDER" glow.scn --quiet --size 1000x1000 --spp 1000000 "$@" >"$TMPDIR/stdout" 2>"$TMPDIR/stderr"
    status=$?
    ends "$what, before the first ray" 1 "mcrender: error: " "$text"
    [ "$(listing)" = "$before" ] || point 1 "$what: nothing is made" "$(listing)"
}
mkdir folder
for option in -o --report; do
    fails "$option in no folder" "No such file or directory" $option absent/a.ppm
    fails "$option at a folder" "it is a folder" $option folder
    fails "$option below a file" "Not a directory" $option glow.scn/a.ppm
    fails "$option with a name too long" "too long" $option "$(printf '%0300d' 0).ppm"
    fails "the second output: $option" "No such file or directory" -o first.ppm $option absent/a.ppm
done
fails "an unknown format" "unknown image format '.xyz'" -o a.xyz
if [ -n "$module" ]; then
    run glow.scn --quiet --size 65501x1 --spp 1 -o wide.jpg -o narrow.ppm
    ends "more columns than JPEG has" 2 "cannot write 'wide.jpg': 65501 x 1 is more than .jpg holds"
    check "nothing is written" test ! -e wide.jpg -a ! -e narrow.ppm
    run glow.scn --quiet --size 65500x1 --spp 1 -o wide.jpg
    ends "as many as it has" 0
    rm -f wide.jpg
else
    skip "JPEG of 65500 columns" "OpenImageIO's module is not built"
fi
MCRENDER_MODULE_PATH=/nonexistent fails "no module" ".exr needs OpenImageIO" -o a.exr
if [ "$(id -u)" != 0 ]; then
    chmod a-w folder
    fails "a folder without permission" "Permission denied" -o folder/a.ppm
    : >read-only.ppm
    chmod a-w read-only.ppm
    fails "a file without permission" "Permission denied" -o read-only.ppm
else
    skip "a folder without permission" "root may write everywhere"
    skip "a file without permission" "root may write everywhere"
fi

# full WHAT OPTION...: status 1 when it is written
full()
{
    run glow.scn --quiet "${@:2}"
    ends "/dev/full: $1" 1 "mcrender: error: cannot write '${*: -1}': No space left on device"
}
full PPM -o /dev/full
full report -o /dev/null --report /dev/full
ln -s /dev/full full.pfm
full "PFM, by a link" -o full.pfm
if [ -n "$module" ]; then
    ln -s /dev/full full.exr
    run glow.scn --quiet -o full.exr
    ends "/dev/full: EXR" 1 "cannot write 'full.exr'"
else
    skip "/dev/full: EXR" "OpenImageIO's module is not built"
fi
[ -L full.pfm ] && [ -c /dev/full ]
point $? "/dev/full: link and device are still there"
"$MCRENDER" glow.scn --quiet -o - >/dev/full 2>"$TMPDIR/stderr"
status=$?
ends "/dev/full: standard output" 1 "cannot write '-': No space left on device"
run glow.scn --quiet -o /dev/full -o good.ppm
ends "/dev/full beside a good target" 1 "/dev/full"
equal "/dev/full: the good target is written" "$(head -c 2 good.ppm)" P6
for how in "--help" "--version" plugins "check glow.scn"; do
    "$MCRENDER" $how >/dev/full 2>"$TMPDIR/stderr"
    status=$?
    ends "/dev/full: $how" 1 "standard output could not be written"
done

# A limit of 1 KiB a file: 64 x 64 pixels need 12.
run glow.scn --quiet -o old.ppm --report old.json
cp old.ppm old && cp old.json old.text
before=$(listing)
for form in ppm pfm ${module:+exr png tiff}; do
    [ $form = ppm ] || cp old.ppm old.$form
    said=$( (ulimit -f 1; exec "$MCRENDER" "$srcdir/scenes/cornell-box.scn" --quiet --size 64x64 --spp 1 -o old.$form) 2>&1)
    equal "a file-size limit: $form" "$? ${said%%:*}" "1 mcrender"
    check "a file-size limit: $form: the old file is whole" cmp old.$form old
    [ $form = ppm ] || rm old.$form
done
said=$( (ulimit -f 1; exec "$MCRENDER" glow.scn --quiet -o small.ppm --report old.json) 2>&1)
equal "a file-size limit: report" "$? $said" "1 mcrender: error: cannot write 'old.json': File too large"
check "a file-size limit: the old report is whole" cmp old.json old.text
rm -f small.ppm
equal "a file-size limit: nothing is left over" "$(listing)" "$before"

# The reader goes away: 256 x 256 pixels are more than a pipe holds.
"$MCRENDER" glow.scn --quiet --size 256x256 -o - 2>"$TMPDIR/stderr" | head -c 2 >/dev/null
status=${PIPESTATUS[0]}
ends "a pipe without a reader" 1 "cannot write '-': Broken pipe"

# ---- closed descriptors ---------------------------------------------------------------------------------------------------------------
run glow.scn --quiet -o open.ppm
closed() # what status command
{
    rm -f closed.ppm
    (eval "$3") 2>"$TMPDIR/stderr"
    status=$?
    ends "$1" "$2"
    if [ "$2" = 0 ]; then check "$1: the picture" cmp closed.ppm open.ppm; fi
}
closed "no standard output" 0 '"$MCRENDER" glow.scn --quiet -o closed.ppm >&-'
closed "no standard input" 0 '"$MCRENDER" glow.scn --quiet -o closed.ppm <&-'
closed "no standard error" 0 '"$MCRENDER" glow.scn -o closed.ppm 2>&-'
closed "nothing at all" 0 '"$MCRENDER" glow.scn -o closed.ppm <&- >&- 2>&-'
closed "no standard output for -o -" 1 '"$MCRENDER" glow.scn --quiet -o - >&-'
closed "no standard output for -o /dev/stdout" 1 '"$MCRENDER" glow.scn --quiet -o /dev/stdout >&-'
closed "no standard output for --report -" 1 '"$MCRENDER" glow.scn --quiet -o a.ppm --report - >&-'
closed "no standard output for --help" 1 '"$MCRENDER" --help >&-'
closed "no standard output for plugins" 1 '"$MCRENDER" plugins >&-'
closed "no standard input for a scene" 3 '"$MCRENDER" - --quiet -o closed.ppm <&-'
finish
