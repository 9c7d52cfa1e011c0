/* SPDX-License-Identifier: Apache-2.0 */
#include <stdio.h>
#include <string.h>

#include "core/core.h"

void mcr_coverage(const struct mcr_scene *scene, struct mcr_coverage *coverage)
{
    /* Mirror-like lobes are followed under every sampler. */
    static const struct {
        uint32_t does, covers;
        const char *what;
    } need[] = {
        {MCR_MATERIAL_REFLECTS, MCR_COVERS_REFLECTION, "reflected"},
        {MCR_MATERIAL_TRANSMITS, MCR_COVERS_TRANSMISSION, "transmitted"},
    };
    const struct mcr_node *directions = scene->sampler->directions;
    uint32_t covers = 0, does = 0;
    size_t used = 0;
    for (uint32_t t = 0; t < directions->technique_count; t++)
        covers |= directions->technique[t].covers;
    for (uint32_t m = 0; m < scene->material_count; m++)
        does |= scene->material[m].traits.does;
    memset(coverage, 0, sizeof *coverage);
    coverage->complete = 1;
    for (size_t i = 0; i < sizeof need / sizeof *need; i++)
        if ((does & need[i].does) && !(covers & need[i].covers)) {
            coverage->complete = 0;
            used += (size_t)snprintf(coverage->missing + used, sizeof coverage->missing - used, "%s%s", used ? ", " : "", need[i].what);
        }
    if (!coverage->complete)
        snprintf(coverage->missing + used, sizeof coverage->missing - used, " light%s", covers & MCR_COVERS_EMITTERS ? " that does not come straight from an emitter" : "");
}
