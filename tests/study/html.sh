#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# report.html for made-up studies: a page without faults of form; and as a browser shows it, narrow and wide, light and dark.
. "$srcdir/tests/tap.sh"
cd "$TMPDIR" || exit 99

pages=$("$builddir/tests/study/report" --write . | grep -v '^#')
check "pages are written" test "$(wc -l <<<"$pages")" = 7
figures_of() { awk -v name="$1" '$1 == name { print $2 }' <<<"$pages"; }
pictures_of() { awk -v name="$1" '$1 == name { print $3 }' <<<"$pages"; }

# ---- form ------------------------------------------------------------------------------------------------------------------------
if command -v python3 >/dev/null; then
    while read -r name figures pictures; do
        empty "$name: well-formed, named, captioned, self-contained" "$(python3 "$srcdir/tests/study/page.py" "$name.html" "$figures" "$pictures" 2>&1)"
    done <<<"$pages"
    sed 's/<img /<img onerror="x()" /; s/scope="row"//; s/<h3>/<h5>/' usual.html >bad.html
    found=$(python3 "$srcdir/tests/study/page.py" bad.html 1 1 2>&1)
    for fault in onerror scope 'not well-formed' '<h5>' 'figures and'; do
        check "a page with a fault is seen: $fault" grep -q -- "$fault" <<<"$found"
    done
else
    skip "the form of the pages" "no python3"
fi

# ---- the manual ------------------------------------------------------------------------------------------------------------------
words=$(sed -n '/^\.Sh STUDY.JSON/,/^\.Sh REPORT.HTML/p' "$srcdir/man/mcrender-study.1" | tr -cs 'a-z_-' '\n')
unknown() { while read -r word; do grep -qxF -- "$word" <<<"$words" || echo "$word"; done; }
metrics='mse rmse mae relmse smape psnr snr snr_variance ssim ms_ssim mean_ratio'
keys() { grep -ho '"[a-z_]*":' ./*/study.json | tr -d '":' | sort -u | grep -vxF "${metrics// /$'\n'}"; }
columns() { sed -n '1s/\r$//p' usual/study.csv | tr ',' '\n' | grep -vxF "${metrics// /$'\n'}"; }
check "study.json has keys, study.csv columns" test "$(keys | wc -l)" -gt 60 -a "$(columns | wc -l)" = 23
empty "every key of study.json is in mcrender-study(1)" "$(keys | unknown)"
empty "every column of study.csv is in mcrender-study(1)" "$(columns | unknown)"
check "one that is not is seen" test "$(echo no_such_key | unknown)" = no_such_key

# ---- in a browser ----------------------------------------------------------------------------------------------------------------
browser=
for name in chromium chromium-browser google-chrome-stable google-chrome; do
    [ -n "$browser" ] || browser=$(command -v "$name")
done
if [ -z "$browser" ]; then
    skip "pages in a browser" "no Chromium"
    finish
fi

# page width light|dark: what measure.js finds, and what stands on the console. In a frame, since no window is narrower than 500 pixels; a frame asks
# for the scheme of the page around it.
browse()
{
    local scheme=1
    [ "$3" = light ] || scheme=0
    echo "<!DOCTYPE html><html style='color-scheme: light dark'><title>frame</title><iframe src='$1' width='$2' height='900' style='border: 0'></iframe></html>" >frame.html
    timeout -k 5 120 "$browser" --headless=new --no-sandbox --disable-gpu --disable-dev-shm-usage --no-first-run --disable-extensions \
        --disable-background-networking --disable-sync --user-data-dir="$TMPDIR/profile" --hide-scrollbars --enable-logging=stderr \
        --allow-file-access-from-files --blink-settings=preferredColorScheme=$scheme --window-size=1500,1000 --dump-dom "file://$PWD/frame.html" 2>console >dom </dev/null
    grep -o 'data-measured="[^"]*"' dom | sed 's/^[^"]*"//; s/"$//'
    grep -i 'CONSOLE' console
}

# The page with the measuring script, which its own policy would forbid.
with_script() { { grep -v 'Content-Security-Policy' "$1" | sed 's|</body>.*||; s|</html>||'; echo "<script>"; cat "$srcdir/tests/study/measure.js"; echo "</script></body></html>"; } >"$2"; }

if ! timeout -k 5 120 "$browser" --headless=new --no-sandbox --disable-gpu --user-data-dir="$TMPDIR/profile" --dump-dom 'data:text/html,<p>alive' 2>/dev/null </dev/null | grep -q alive; then
    skip "pages in a browser" "$browser does not start here"
    finish
fi

shows() # page width light|dark
{
    local expected pictures found
    with_script "$1.html" seen.html
    pictures=$(pictures_of "$1")
    [ "$pictures" != 0 ] || pictures=$(grep -c '<img ' "$1.html")
    expected="$2 $3 fits $(figures_of "$1") $pictures whole"
    found=$(browse seen.html "$2" "$3")
    point "$([ "$found" = "$expected" ]; echo $?)" "$1, $2 pixels wide, $3" "expected $expected; found $found"
}
for width in 400 1400; do
    for scheme in light dark; do
        shows usual $width $scheme
    done
done
shows many 400 dark
shows hostile 400 light
shows hostile 1400 dark
shows interrupted 400 light
shows unknown 400 light
shows one 1400 light
empty "as it is, under its own policy: nothing on the console" "$(browse usual.html 1400 light)"

# Pages that are broken on purpose are seen to be.
sees() # what page pattern
{
    local found
    with_script "$2" seen.html
    found=$(browse seen.html 400 light)
    check "a broken page is seen: $1" grep -q -- "$3" <<<"$found"
}
sed 's|<main>|<main><div style="width:900px">wide</div>|' one.html >bad.html
sees "it overflows" bad.html ' overflows:'
sed '0,/base64,iVBOR/s//base64,iVBOX/' one.html >bad.html
sees "a picture that does not decode" bad.html 'broken:.*the whole image'
sed 's|</main>|</main><script>missing.part()</script>|' one.html >bad.html
sees "an error on the console" bad.html CONSOLE
sed 's|font-size:15px|font-size:44px|' usual.html >bad.html
sees "labels that meet or are cut" bad.html 'broken:'
finish
