/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Plugins whose tables are right and whose operations are not: what create, techniques and traits may tell wrongly, and that every
 * instance that was made is destroyed. The plugins are tables of this program, put into nodes directly. And the host of creation.
 */
#include "../tap.h"
#include "plugin/create.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static int created, destroyed;
static int32_t status;
static const char *message;
static struct mcr_technique told[MCR_MAX_TECHNIQUES];
static uint32_t told_count;
static struct mcr_material_traits told_traits;

static int32_t create(const struct mcr_host *host, struct mcr_context *context, const struct mcr_creation *with, void **instance)
{
    (void)with;
    if (message)
        host->report(host, context, MCR_REPORT_ERROR, message);
    if (status == MCR_OK) {
        created++;
        *instance = &created;
    }
    return status;
}

static void destroy(void *instance)
{
    destroyed += instance == &created;
}

static int32_t techniques(const struct mcr_host *host, struct mcr_context *context, const void *instance, struct mcr_technique *technique,
                          uint32_t *count)
{
    (void)host, (void)context, (void)instance;
    for (uint32_t k = 0; k < MCR_MAX_TECHNIQUES; k++)
        technique[k] = told[k];
    *count = told_count;
    return MCR_OK;
}

static int32_t no_draw(const struct mcr_host *host, struct mcr_context *context, const void *instance, uint32_t technique,
                       const struct mcr_points *at, const double *const *number, const struct mcr_directions *out, double *density)
{
    (void)host, (void)context, (void)instance, (void)technique, (void)at, (void)number, (void)out, (void)density;
    return MCR_E_INTERNAL;
}

static int32_t no_density(const struct mcr_host *host, struct mcr_context *context, const void *instance, uint32_t technique,
                          const struct mcr_points *at, const struct mcr_directions *toward, double *density)
{
    (void)host, (void)context, (void)instance, (void)technique, (void)at, (void)toward, (void)density;
    return MCR_E_INTERNAL;
}

static int32_t traits(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_values *values,
                      struct mcr_material_traits *traits)
{
    (void)host, (void)context, (void)instance, (void)values;
    *traits = told_traits;
    return status;
}

static int32_t emission(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                        const struct mcr_points *at, const struct mcr_colours *out)
{
    (void)host, (void)context, (void)instance, (void)inputs, (void)at, (void)out;
    return MCR_E_INTERNAL;
}

static const struct mcr_directions_plugin directions = {
    .head = {sizeof directions, MCR_KIND_DIRECTIONS, 0, 0, "probe", "1", "MIT", "for tests", NULL},
    .create = create,
    .destroy = destroy,
    .techniques = techniques,
    .draw = no_draw,
    .density = no_density,
};
static const struct mcr_material_plugin material = {
    .head = {sizeof material, MCR_KIND_MATERIAL, 0, 0, "probe", "1", "MIT", "for tests", NULL},
    .create = create,
    .destroy = destroy,
    .traits = traits,
    .emission = emission,
};

/* Whether the diagnostics say so, and how many errors they hold. */
static int says(struct mcr_diagnostics *diagnostics, const char *what, uint32_t errors)
{
    char *text = NULL;
    size_t length = 0;
    FILE *memory = open_memstream(&text, &length);
    int found;

    mcr_diagnostics_print(diagnostics, memory, 0);
    fclose(memory);
    found = strstr(text, what) != NULL && mcr_diagnostics_errors(diagnostics) == errors;
    if (!found)
        printf("# %s", text);
    free(text);
    return found;
}

static void test_create(int32_t returns, const char *reports, const char *expected)
{
    struct mcr_diagnostics *diagnostics = mcr_diagnostics_create();
    struct mcr_node node = {.descriptor = &directions.head};
    int failed;

    created = destroyed = 0;
    status = returns;
    message = reports;
    failed = mcr_node_instantiate(&node, diagnostics, 1, 0);
    ok(failed == -1 && says(diagnostics, expected, 1), "create returns %d: %s", returns, expected);
    ok(created == destroyed, "  what was made is destroyed");
    status = MCR_OK;
    message = NULL;
    mcr_diagnostics_destroy(diagnostics);
}

static void test_techniques(uint32_t count, struct mcr_technique first, struct mcr_technique second, const char *expected)
{
    struct mcr_diagnostics *diagnostics = mcr_diagnostics_create();
    struct mcr_node node = {.descriptor = &directions.head};

    told[0] = first, told[1] = second;
    told_count = count;
    ok(mcr_node_techniques(&node, diagnostics, 0) == -1 && says(diagnostics, expected, 1), "%s", expected);
    mcr_diagnostics_destroy(diagnostics);
}

static void test_traits(uint32_t does, double radiance, int32_t returns, const char *expected)
{
    struct mcr_diagnostics *diagnostics = mcr_diagnostics_create();
    struct mcr_node node = {.descriptor = &material.head};
    struct mcr_material_traits traits_read;

    told_traits = (struct mcr_material_traits){.size = sizeof told_traits, .does = does, .radiance = {0, radiance, 0}};
    status = returns;
    ok(mcr_material_traits(&node, diagnostics, &traits_read) == -1 && says(diagnostics, expected, 1), "%s", expected);
    status = MCR_OK;
    mcr_diagnostics_destroy(diagnostics);
}

/* What the creation host offers and what it refuses. */
static void test_host(void)
{
    const struct mcr_host *host = mcr_creation_host();
    struct mcr_node child = {.descriptor = &directions.head, .technique_count = 1, .technique = {{sizeof *told, 1, 1, 1, 2, 0}}};
    struct mcr_node node = {.descriptor = &directions.head};
    struct mcr_context context = {.node = &node, .has_lights = 1};
    struct mcr_technique small[MCR_MAX_TECHNIQUES] = {{.size = 12, .dimensions = 77}};
    uint32_t count = 0;

    ok(host->size == sizeof *host && host->major == MCR_PLUGIN_MAJOR && host->minor == MCR_PLUGIN_MINOR, "the host tells its version");
    ok(host->child_techniques(host, &context, (const struct mcr_child *)&child, small, &count) == MCR_OK && count == 1 && small[0].covers == 1 &&
           small[0].dimensions == 77 && small[0].size == 12,
       "techniques of a child, no more of them than the caller knows of");
    ok(host->child_draw(host, &context, NULL, 0, NULL, NULL, NULL, NULL) == MCR_E_UNSUPPORTED &&
           host->child_density(host, &context, NULL, 0, NULL, NULL, NULL) == MCR_E_UNSUPPORTED &&
           host->child_mass(host, &context, NULL, 0, NULL, NULL) == MCR_E_UNSUPPORTED &&
           host->light_draw(host, &context, 0, NULL, NULL, NULL, NULL) == MCR_E_UNSUPPORTED &&
           host->light_density(host, &context, 0, NULL, NULL, NULL) == MCR_E_UNSUPPORTED &&
           host->light_mass(host, &context, 0, NULL, NULL) == MCR_E_UNSUPPORTED &&
           host->light_draw_point(host, &context, 0, NULL, NULL, NULL, NULL) == MCR_E_UNSUPPORTED &&
           host->light_density_point(host, &context, 0, NULL, NULL, NULL) == MCR_E_UNSUPPORTED &&
           host->material_draw(host, &context, NULL, NULL, NULL, NULL) == MCR_E_UNSUPPORTED &&
           host->material_density(host, &context, NULL, NULL, NULL) == MCR_E_UNSUPPORTED && host->scratch(host, &context) == NULL,
       "nothing that needs a scene is offered while nodes are made");
    ok(host->has_lights(host, &context) == 1, "whether there are lights is known");
}

int main(void)
{
    const struct mcr_technique fine = {sizeof fine, MCR_TECHNIQUE_DIRECTION, MCR_COVERS_REFLECTION, 1, 2, 0};
    struct mcr_technique odd = fine, other = fine;

    test_create(MCR_E_INVALID, "these do not go together", "error: these do not go together");
    test_create(MCR_E_INVALID, NULL, "'probe' failed in 'create': its parameters cannot work together");
    test_create(MCR_E_NOMEM, NULL, "out of memory");
    test_create(MCR_E_UNSUPPORTED, NULL, "it needs a service that this program lacks");
    test_create(MCR_E_INTERNAL, NULL, "internal error");
    test_create(7, NULL, "it returned a status that does not exist");
    test_create(MCR_OK, "an error, but it went on", "error: an error, but it went on");

    test_techniques(0, fine, fine, "'probe' tells of 0 techniques, expected 1 to 4: a mistake in the plugin");
    test_techniques(5, fine, fine, "'probe' tells of 5 techniques");
    test_techniques(UINT32_MAX, fine, fine, "'probe' tells of 4294967295 techniques");
    test_techniques(2, fine, fine, "2 techniques of 'probe' continue the path, expected at most one");
    odd.kind = 3;
    test_techniques(1, odd, fine, "technique 1 of 'probe' is of an unknown kind");
    odd.kind = MCR_TECHNIQUE_EMITTER;
    test_techniques(1, odd, fine, "technique 1 of 'probe' draws points on emitters, but the plugin has no operation draw_emitter");
    other.continues = 2;
    test_techniques(2, fine, other, "technique 2 of 'probe' continues the path without drawing directions");
    other = fine;
    other.covers = 64;
    test_techniques(2, fine, other, "technique 2 of 'probe' covers something unknown");

    test_traits(1u << 20, 0, MCR_OK, "'probe' tells of something unknown that it does");
    test_traits(MCR_MATERIAL_REFLECTS, 0, MCR_OK, "'probe' scatters, but has no operation evaluate");
    test_traits(MCR_MATERIAL_DELTA, 0, MCR_OK, "'probe' has delta lobes, but no operation delta");
    test_traits(MCR_MATERIAL_EMITS_FRONT, -1, MCR_OK, "'probe' tells of a radiance that is negative or not finite");
    test_traits(MCR_MATERIAL_EMITS_FRONT, NAN, MCR_OK, "'probe' tells of a radiance that is negative or not finite");
    test_traits(MCR_MATERIAL_EMITS_FRONT, INFINITY, MCR_OK, "'probe' tells of a radiance that is negative or not finite");
    test_traits(MCR_MATERIAL_EMITS_FRONT, 1, MCR_E_INTERNAL, "'probe' failed in 'traits': internal error");
    test_host();
    return tap_done();
}
