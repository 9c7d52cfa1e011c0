/* SPDX-License-Identifier: Apache-2.0 */
/* The harness itself: the environment that every test relies on. */
#include "../tap.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static void absolute(const char *name)
{
    const char *value = getenv(name);
    ok(value && value[0] == '/', "%s is an absolute path: %s", name, value ? value : "(unset)");
}

int main(void)
{
    static const char *const paths[] = {"MCRENDER", "MCRENDER_PLUGIN_PATH", "MCRENDER_MODULE_PATH", "srcdir", "builddir", "HOME", "TMPDIR"};
    for (size_t i = 0; i < sizeof paths / sizeof *paths; i++)
        absolute(paths[i]);
    const char *locale = getenv("LC_ALL");
    ok(locale && !strcmp(locale, "C"), "the locale is C");
    ok(access(getenv("TMPDIR") ? getenv("TMPDIR") : "", W_OK) == 0, "TMPDIR can be written");
    return tap_done();
}
