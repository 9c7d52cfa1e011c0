#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# The manual tells the truth: every example in the man pages is taken out of them and run, and what the pages list is what there is.
# How an example is run stands in a comment before it in the mdoc source:
#     test: check          a complete scene: checked without a warning, and rendered tiny
#     test: fragment       the same, after the camera and the materials white and lamp, where it lacks them, were put before it
#     test: file NAME      saved as NAME for the examples behind it on the same page
#     test: error NAME     the exact output of `mcrender check NAME`
#     test: shell [oiio]   run by sh -eu; status 0. oiio: only where OpenImageIO is there
#     test: none           not an example
#     test: report         the first words of the lines are those of the report of a render with --profile
# and before a list, words: TEXT, a scene's text that makes the program list the words it expects: those that the list has.
. "$srcdir/tests/tap.sh"

mkdir -p "$TMPDIR/bin" || exit 99
# What the examples call by its bare name: the program and the compiler under test, and the flags that pkg-config would tell.
# MCR_CFLAGS may hold a sanitizer, without which a plugin still loads; the plugin is compiled as the page says.
flags=$(sed -n 's/^Cflags: -I[^ ]* *//p' "$builddir/mcrender-plugin.pc" 2>/dev/null)
printf '#!/bin/sh\nexec "%s" "$@"\n' "$MCRENDER" >"$TMPDIR/bin/mcrender"
printf '#!/bin/sh\nPATH="%s"\nexec %s "$@"\n' "$PATH" "${MCR_CC:-cc}" >"$TMPDIR/bin/cc"
printf '#!/bin/sh\n[ "$1 $2" = "--cflags mcrender-plugin" ] && echo "-I%s/src %s"\n' "$srcdir" "$flags" >"$TMPDIR/bin/pkg-config"
chmod +x "$TMPDIR/bin"/* || exit 99
PATH=$TMPDIR/bin:$PATH

# The displays of PAGE go to FOLDER/NUMBER.text, FOLDER/list gets "NUMBER LINE KIND NAME", and FOLDER/mistakes what is not marked.
extract() # page folder
{
    awk -v to="$2" '
        /^\.\\" test: / { kind = $3; name = $4; next }
        /^\.Bd -literal/ { if (kind == "") print "line " NR ": a display without a test: comment" >(to "/mistakes")
                           file = to "/" ++count ".text"; printf "" >file
                           print count, NR, kind == "" ? "none" : kind, name >(to "/list"); kind = name = ""; inside = 1; next }
        kind != "" { print "line " NR ": a test: comment that no display follows" >(to "/mistakes"); kind = "" }
        /^\.Ed/ { inside = 0; close(file); next }
        inside { gsub(/\\e/, "\\"); gsub(/\\&/, ""); gsub(/\\-/, "-"); gsub(/\\\(dq/, "\""); gsub(/\\\(aq/, "\047"); print >file }' "$1"
}

render() # scene…: no message at all, status 0
{
    local said
    said=$(mcrender "$@" --quiet --size 8x8 --spp 4 -o picture.pfm 2>&1) && [ -z "$said" ] && return 0
    echo "$said"
    return 1
}

checked() # scene: no warning, and a picture
{
    local said
    said=$(mcrender check --werror --quiet "$1" 2>&1) && [ -z "$said" ] || { echo "$said"; return 1; }
    # what the film of an example crops does not fit a tiny picture
    if grep -q crop "$1"; then return 0; fi
    render "$1"
}

complete() # fragment scene
{
    {
        echo 'mcrender 1'
        grep -q '^camera' "$1" || echo 'camera perspective { from (0, 3, 12)   to (0, 0, 0)   fov 40 }'
        grep -q '^material white' "$1" || echo 'material white lambert { albedo 0.7 }'
        echo 'material lamp emitter { radiance 10 }'
        echo 'disk { center (0, 9, 0)   normal (0, -1, 0)   radius 1   material lamp }'
        echo 'plane { point (0, -1, 0)   normal (0, 1, 0)   material white }'
        cat "$1"
    } >"$2"
}

shell() { sh -eu "$1" </dev/null 2>&1; }

first_words() { sed -n 's/^\([a-z][a-z]*\) .*/\1/p' "$1" | sort -u; }

reported() # sample: the words of the report are those that the sample shows
{
    mcrender cornell-box.scn --size 8x8 --spp 4 --profile -o report.ppm 2>report.text || return 1
    diff <(first_words "$1") <(first_words report.text)
}

failed_as() # name text
{
    mcrender check "$1" >said 2>&1 && { echo "no error"; return 1; }
    diff "$2" said
}

# The small version of the scene that the pages' commands name.
example_scene()
{
    sed -e 's/size (512, 512)/size (24, 24)/' -e 's/^\( *spp *\)100/\14/' "$srcdir/scenes/cornell-box.scn" >"$1"
    grep -q 'size (24, 24)' "$1" && grep -q 'spp *4$' "$1"
}

run_page() # page
{
    local page=${1##*/} folder=$TMPDIR/${1##*/} number line kind name
    mkdir -p "$folder" && cd "$folder" || exit 99
    extract "$1" .
    empty "$page: every display says how it is tested" "$(cat mistakes 2>/dev/null)"
    check "$page: there are examples" test -s list
    example_scene cornell-box.scn || { point 1 "$page: the scene of the examples"; return; }
    while read -r number line kind name; do
        case $kind in
        none) ;;
        check) cp "$number.text" "$number.scn"; check "$page:$line: a scene" checked "$number.scn" ;;
        fragment) complete "$number.text" "$number.scn"; check "$page:$line: a part of a scene" checked "$number.scn" ;;
        file) cp "$number.text" "$name"; check "$page:$line: $name" test -s "$name" ;;
        error) check "$page:$line: the messages of $name" failed_as "$name" "$number.text" ;;
        shell)
            if [ "$name" = oiio ] && [ ! -f "$MCRENDER_MODULE_PATH/oiio.so" ]; then skip "$page:$line: commands" "no OpenImageIO"; continue; fi
            check "$page:$line: commands" shell "$number.text" ;;
        report) check "$page:$line: a report" reported "$number.text" ;;
        *) point 1 "$page:$line: an example" "unknown kind '$kind'" ;;
        esac
    done <list
}

# ---- words ------------------------------------------------------------------------------------------------------------------------
# What the program expects instead of `zzz`.
expected_words() # text
{
    printf 'mcrender 1\n%s\n' "$1" >words.scn
    mcrender check words.scn 2>&1 | sed -n "s/.*unknown [a-z]* 'zzz' .*, expected \(.*\)/\1/p" | sed 's/ or /, /; s/, /\n/g' | sort -u
}

# words.list gets "NUMBER TEXT" for every words: comment, and NUMBER.words the words of the list behind it.
extract_words() # page
{
    awk '
        /^\.\\" words: / { sub(/^\.\\" words: /, ""); count++; print count, $0 >"words.list"; depth = 0; wanted = 1; next }
        wanted && /^\.Bl/ { depth++; next }
        wanted && depth && /^\.El/ { if (--depth == 0) wanted = 0; next }
        wanted && depth == 1 && /^\.It/ { key = 0
            for (i = 2; i <= NF; i++) {
                if ($i == "Cm" || $i == "Ic") key = $(i - 1) != "Pq"
                else if ($i == ",") key = 1
                else { if (key && $i ~ /^[a-z_]+$/) print $i >(count ".words"); key = 0 }
            } }' "$1"
}

run_words() # page
{
    local page=${1##*/} number text
    cd "$TMPDIR/${1##*/}" || exit 99
    extract_words "$1"
    [ -f words.list ] || return
    while read -r number text; do
        expected_words "$text" >"$number.expected"
        if [ ! -s "$number.expected" ]; then point 1 "$page: the words of: $text" "the program lists none"; continue; fi
        check "$page: the words of: $text" diff "$number.expected" <(sort -u "$number.words")
    done <words.list
}

# ---- options and keys -------------------------------------------------------------------------------------------------------------
options_told() { mcrender --help | grep -oE '  -[-a-z]+' | tr -d ' ' | sort -u; }
options_listed() { sed -n 's/^\.It Fl Fl \([a-z-]*\).*/--\1/p; s/^\.It Fl \(o\) .*/-\1/p' "$1" | sort -u; }
keys_told()
{
    mcrender cornell-box.scn --size 8x8 --spp 4 --profile --quiet -o keys.ppm --report keys.json || return 1
    mcrender cornell-box.scn --size 8x8 --spp 64 --adaptive --time 100 --target-error 100 --quiet -o keys.ppm --report rounds.json || return 1
    # the last four are there only if a sample was not finite
    { sed -n 's/^ *"\([a-z_]*\)": .*/\1/p' keys.json rounds.json; printf '%s\n' not_finite_first x y sample; } | sort -u
}
keys_listed() { sed -n '/^\.\\" keys: begin/,/^\.\\" keys: end/p' "$1" | sed -n 's/^\.It Cm //p' | tr ' ' '\n' | grep '^[a-z_]*$' | sort -u; }

for page in mcrender.1 mcrender-compare.1 mcrender-study.1 mcrender-scene.5 mcrender-plugin.7; do
    [ -f "$srcdir/man/$page" ] || { point 1 "$page exists"; continue; }
    run_page "$srcdir/man/$page"
    run_words "$srcdir/man/$page"
done

# The scene in README.md: the block that begins with the format's version.
mkdir -p "$TMPDIR/README.md" && cd "$TMPDIR/README.md" || exit 99
awk '/^```/ { inside = 0 } /^```$/ { getline; if (/^mcrender 1/) inside = 1 } inside' "$srcdir/README.md" >scene.scn
check "README.md: the scene" checked scene.scn
check "README.md: the scene was found" grep -q sphere scene.scn

# The furnace of the plugin's example: radiance 1 and albedo 1/2 everywhere make 2.
cd "$TMPDIR/mcrender-plugin.7" || exit 99
mcrender furnace.scn --plugin ./lobe.so --quiet -o furnace.pfm --report furnace.json
check "mcrender-plugin.7: the example's picture is 2 within 4 standard errors" awk -F '[:,]' '
    /"luminance"/ { mean = $2 } /"standard_error"/ { error = $2 }
    END { print mean, error; exit !(error > 0 && error < 0.01 && (mean - 2) ^ 2 <= (4 * error) ^ 2) }' furnace.json

cd "$TMPDIR/mcrender.1" || exit 99
check "mcrender.1: the options of --help" diff <(options_told) <(options_listed "$srcdir/man/mcrender.1")
check "mcrender.1: the keys of --report" diff <(keys_told) <(keys_listed "$srcdir/man/mcrender.1")
finish
