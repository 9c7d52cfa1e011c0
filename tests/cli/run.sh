# SPDX-License-Identifier: Apache-2.0
# For the tests of the command line; sourced, after tests/tap.sh. Works in an empty folder of its own.
mkdir -p "$TMPDIR/work" && cd "$TMPDIR/work" || exit 99

# run ARGUMENT...: the program; sets status, leaves $TMPDIR/stdout and $TMPDIR/stderr
run()
{
    "$MCRENDER" "$@" >"$TMPDIR/stdout" 2>"$TMPDIR/stderr" </dev/null
    status=$?
}

# ends WHAT STATUS [TEXT]...: a point: how the last run ended, and what stderr holds
ends()
{
    local what=$1 wanted=$2 text
    shift 2
    if [ "$status" != "$wanted" ]; then
        point 1 "$what" "status $status, not $wanted: $(cat "$TMPDIR/stderr")"
        return
    fi
    for text; do
        grep -qF -- "$text" "$TMPDIR/stderr" && continue
        point 1 "$what" "stderr lacks '$text': $(cat "$TMPDIR/stderr")"
        return
    done
    point 0 "$what"
}

# equal WHAT FOUND WANTED: a point
equal() { [ "$2" = "$3" ]; point $? "$1" "'$2', expected '$3'"; }

# value KEY FILE: of the first such key in a report as we write it, one member a line; the words of a text without their quotes
value() { sed -n 's/^ *"'"$1"'": *"\{0,1\}\(.*[^",]\)"\{0,1\},\{0,1\}$/\1/p' "$2" | head -n 1; }

# What is in the folder, on one line; names that begin with a dot too.
listing() { ls -A | sort | tr '\n' ' ' | sed 's/ $//'; }

# A plugin from tests/cli/NAME.c in the folder $TMPDIR.
compile_plugin() # name
{
    ${MCR_CC:-cc} -std=gnu17 -O2 -shared -fPIC -I"$srcdir/src" "$srcdir/tests/cli/$1.c" -o "$TMPDIR/$1.so"
}

# glow.scn: a picture of one colour, grey; every setting of it differs from the default
cat >glow.scn <<'TEXT'
mcrender 1
let glow = 0.25
camera orthographic { from (0, 0, 5)   to (0, 0, 0)   height 2 }
film { size (8, 8) }
render { sampler cosine   spp 4   depth 2   seed 11   threads 1   accel bvh   batch 24   roulette off }
material lamp emitter { radiance glow }
quad { corner (-9, -9, 0)   u (18, 0, 0)   v (0, 18, 0)   material lamp }
TEXT
