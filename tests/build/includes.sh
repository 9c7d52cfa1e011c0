#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# The edges between folders: a folder includes from folders to its left and from the public headers; C++ only below src/modules/;
# a plugin includes nothing but the public headers, those of C and its own, plugins/WORD_*.h.
. "$srcdir/tests/tap.sh"

order="base language plugin image scene accel core film metrics study cli"

rank() # position of a folder, or 0
{
    local i=0 folder
    for folder in $order; do
        i=$((i + 1))
        [ "$folder" = "$1" ] && { echo $i; return; }
    done
    echo 0
}

includes() # files… : FILE:INCLUDED, with its quotes or brackets
{
    [ $# = 0 ] || grep -HoE '^[[:space:]]*#[[:space:]]*include[[:space:]]*["<][^">]*[">]' "$@" | sed -E 's/:[[:space:]]*#[^"<]*/:/'
}

folder_edges() # top of a source tree: prints what breaks them
{
    local folder here line file what target there
    for folder in mcrender $order modules; do
        [ -d "$1/src/$folder" ] || continue
        here=$(rank "$folder")
        while IFS= read -r line; do
            file=${line%%:*} what=${line#*:}
            case $what in
            '<mcrender/'*) continue ;;
            '<'*) target=${what#<}; target=${target%%/*}; [ "$(rank "$target")" = 0 ] || echo "$file: $what: write it with quotes"; continue ;;
            esac
            target=${what#\"}
            case $target in
            */*) target=${target%%/*} ;;
            *) echo "$file: $what: say which folder"; continue ;;
            esac
            there=$(rank "$target")
            case $folder in
            mcrender) echo "$file: $what: a public header includes public headers only" ;;
            modules) # behind a private C interface: what the modules serve, and nothing that knows of rendering
                [ "$target" = modules ] || { [ "$there" != 0 ] && [ "$there" -le "$(rank scene)" ]; } || echo "$file: $what: not for modules" ;;
            *) [ "$there" != 0 ] && [ "$there" -le "$here" ] || echo "$file: $what: not to the left of src/$folder" ;;
            esac
        done < <(includes $(find "$1/src/$folder" -name '*.[ch]' -o -name '*.cc' -o -name '*.inc.h' | sort))
    done
}

cxx_elsewhere()
{
    (cd "$1" && find src plugins tests -type f \( -name '*.cc' -o -name '*.cpp' -o -name '*.cxx' -o -name '*.hh' -o -name '*.hpp' \) \
        ! -path 'src/modules/*' 2>/dev/null)
}

c_headers='assert complex ctype errno fenv float inttypes iso646 limits locale math setjmp signal stdalign stdarg stdatomic stdbool stddef stdint
    stdio stdlib stdnoreturn string tgmath threads time uchar wchar wctype'
plugin_includes()
{
    local line what word
    while IFS= read -r line; do
        what=${line#*:} word=${line%%:*}
        word=${word##*/} word=${word%.[ch]}
        case $what in
        '<mcrender/'* | \""${word%%_*}"_*.h\") ;;
        '<'*.h'>') what=${what#<}; case " ${c_headers//$'\n'/ } " in *" ${what%.h>} "*) ;; *) echo "$line" ;; esac ;;
        *) echo "$line" ;;
        esac
    done < <(includes $(find "$1/plugins" -name '*.[ch]' | sort))
}

empty "folders include only from the left" "$(folder_edges "$srcdir")"
empty "C++ only below src/modules" "$(cxx_elsewhere "$srcdir")"
empty "plugins include only public headers and those of C" "$(plugin_includes "$srcdir")"

# The checks themselves, on a tree that breaks each rule once.
bad=$TMPDIR/bad
mkdir -p "$bad"/{src/{base,core,mcrender,modules},plugins}
printf '#include "core/batch.h"\n' >"$bad/src/base/upward.c"
printf '  #  include "batch.h"\n' >"$bad/src/core/bare.c"
printf '#include <base/arena.h>\n' >"$bad/src/core/bracket.c"
printf '#include "base/arena.h"\n' >"$bad/src/mcrender/private.h"
printf '#include "cli/main.h"\n' >"$bad/src/modules/module.cc"
printf '#include "base/arena.h"\n#include <mcrender/plugin.h>\n#include <math.h>\n' >"$bad/src/core/good.c"
printf '#include "base/arena.h"\n' >"$bad/plugins/private.c"
printf '#include <unistd.h>\n' >"$bad/plugins/system.c"
printf '#include "foreign_parts.h"\n' >"$bad/plugins/other.c"
printf '#include "good_parts.h"\n#include <mcrender/plugin.h>\n#include <math.h>\n' >"$bad/plugins/good.c"
: >"$bad/src/core/plus.cc"
found=$(folder_edges "$bad")
for file in base/upward.c core/bare.c core/bracket.c mcrender/private.h modules/module.cc; do
    check "a broken edge is seen: $file" grep -q "/$file:" <<<"$found"
done
refute "a good file is not blamed" grep -q good <<<"$found"
check "C++ in src/core is seen" test "$(cxx_elsewhere "$bad")" = src/core/plus.cc
found=$(plugin_includes "$bad")
check "a plugin's private header is seen" grep -q private.c <<<"$found"
check "another plugin's header is seen" grep -q other.c <<<"$found"
check "a plugin's system header is seen" grep -q system.c <<<"$found"
refute "a good plugin is not blamed" grep -q good.c <<<"$found"
finish
