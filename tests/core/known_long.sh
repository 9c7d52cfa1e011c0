# SPDX-License-Identifier: Apache-2.0
# The part of known.sh that takes more than 3 million samples a render.
part=long
. "$srcdir/tests/core/known.sh"
