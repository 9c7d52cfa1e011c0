# SPDX-License-Identifier: Apache-2.0
# What the tests of `mcrender study` share; sourced after tap.sh.
cd "$TMPDIR" || exit 99

# tiny STUDY-BLOCK...: tiny.scn, a room of 8 x 8 pixels with a lamp, that asks for the rest
tiny()
{
    cat >tiny.scn <<TEXT
mcrender 1
camera perspective { from (0, 1, 3.4)   to (0, 1, 0)   fov 40 }
film { size (8, 8) }
render { depth 2   threads 1 }
material white lambert { albedo 0.73 }
material lamp emitter { radiance 4 }
box { min (-1, -0.1, -1)   max (1, 0, 1)   material white }
quad { corner (-1, 0, -1)   u (2, 0, 0)   v (0, 2, 0)   material white }
quad { corner (-0.5, 1.99, -0.5)   u (1, 0, 0)   v (0, 0, 1)   material lamp }
study { $* }
TEXT
}

study() # ARGUMENT...: status; stdout, stderr
{
    "$MCRENDER" study "$@" >stdout 2>stderr </dev/null
    status=$?
}

# ends WHAT STATUS [TEXT-IN-STDERR]
ends()
{
    if [ $status != "$2" ]; then
        point 1 "$1" "status $status instead of $2: $(cat stderr)"
    elif [ -n "$3" ] && ! grep -qF -- "$3" stderr; then
        point 1 "$1" "no '$3' in: $(cat stderr)"
    else
        point 0 "$1"
    fi
}

# figures FOLDER: the errors of its runs, and its sums: all that does not depend on time or order
figures()
{
    grep -a '"run"' "$1/journal.jsonl" | sed -e 's/"order":.*"seed"/"seed"/' -e 's/"wall":.*"samples"/"samples"/' -e 's/,"check".*//' | sort
    (cd "$1/state" && cksum ./*.sums)
    grep '"bias_square' "$1/study.json"
}
runs() { cat "$1/journal.jsonl" 2>/dev/null | grep -ac '"run"'; }
