#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# A plugin exports one data symbol, mcr_plugin.
. "$srcdir/tests/tap.sh"
command -v nm >/dev/null || skip_all "exports.sh: no nm"
[ "$MCR_SANITIZED" != 1 ] || skip_all "exports.sh: sanitizers export symbols of their own"

for word in $MCR_PLUGINS; do
    exported=$(nm -D --defined-only "$MCRENDER_PLUGIN_PATH/$word.so" 2>&1 | awk '{ print $2, $3 }')
    case $exported in
    'D mcr_plugin' | 'R mcr_plugin') point 0 "$word.so exports mcr_plugin alone" ;;
    *) point 1 "$word.so exports mcr_plugin alone" "$exported" ;;
    esac
done
listed=" $MCR_PLUGINS "
for file in "$srcdir"/plugins/*.c; do
    word=$(basename "$file" .c)
    case $listed in *" $word "*) ;; *) point 1 "plugins/$word.c is built" "not among plugin_words" ;; esac
done
finish
