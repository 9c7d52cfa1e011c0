# SPDX-License-Identifier: Apache-2.0
# The part of known.sh that takes more than 3 million samples a render.
part=long
[ "$MCR_SANITIZED" != 1 ] || { echo "1..0 # SKIP $part: too long with sanitizers"; exit 0; }
. "$srcdir/tests/core/known.sh"
