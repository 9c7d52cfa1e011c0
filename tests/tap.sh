# SPDX-License-Identifier: Apache-2.0
# The Test Anything Protocol for shell tests; sourced:  . "$srcdir/tests/tap.sh"
#     check "what is tested" COMMAND…     one point; the command's output is shown where it fails
#     refute "what is tested" COMMAND…    one point; the command must fail
#     empty "what is tested" "$text"      one point; the text must be empty and is shown otherwise
#     skip "what" "why"                   one point left out
#     skip_all "why"                      the whole test left out
#     finish                              the plan; at the end
tap_count=0
tap_failed=0

point() # passed(0|1) what [explanation]
{
    tap_count=$((tap_count + 1))
    if [ "$1" = 0 ]; then
        echo "ok $tap_count - $2"
    else
        echo "not ok $tap_count - $2"
        tap_failed=$((tap_failed + 1))
        [ -z "$3" ] || printf '%s\n' "$3" | head -n 40 | sed 's/^/# /'
    fi
}

check()
{
    local what=$1 output status
    shift
    output=$("$@" 2>&1)
    status=$?
    [ $status = 0 ] && point 0 "$what" || point 1 "$what" "status $status: $output"
}

refute()
{
    local what=$1 output
    shift
    if output=$("$@" 2>&1); then point 1 "$what" "succeeded: $output"; else point 0 "$what"; fi
}

empty()
{
    [ -z "$2" ] && point 0 "$1" || point 1 "$1" "$2"
}

skip()
{
    tap_count=$((tap_count + 1))
    echo "ok $tap_count - $1 # SKIP $2"
}

skip_all()
{
    echo "1..0 # SKIP $1"
    exit 0
}

finish()
{
    echo "1..$tap_count"
    [ $tap_failed = 0 ]
    exit
}
