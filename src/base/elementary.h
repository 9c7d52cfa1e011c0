/* SPDX-License-Identifier: Apache-2.0 */
/* Elementary functions of our own. Plugins need them too: they are in a public header. */
#ifndef MCR_BASE_ELEMENTARY_H
#define MCR_BASE_ELEMENTARY_H

#include <mcrender/math.h>

#endif
