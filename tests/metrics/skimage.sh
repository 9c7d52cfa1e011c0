#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# The metrics of `mcrender compare` against scikit-image and numpy, on images made by tests/metrics/similarity.py.
. "$srcdir/tests/tap.sh"

python=
for candidate in python3 /usr/bin/python3; do
    if "$candidate" -c 'import numpy, skimage.metrics' >/dev/null 2>&1; then python=$candidate; break; fi
done
[ -n "$python" ] || skip_all "no python3 with scikit-image (Debian's python3-skimage)"
mkdir -p "$TMPDIR/work" && cd "$TMPDIR/work" || exit 99
PYTHONDONTWRITEBYTECODE=1 "$python" "$srcdir/tests/metrics/similarity.py" "$MCRENDER"
