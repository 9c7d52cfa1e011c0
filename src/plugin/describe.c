/* SPDX-License-Identifier: Apache-2.0 */
#include "plugin/describe.h"

#include <string.h>

#include "base/cpu.h"
#include "plugin/values.h"

static const char *const kind_title[] = {[MCR_KIND_DIRECTIONS] = "samplers: directions",
                                         [MCR_KIND_NUMBERS] = "samplers: numbers (outermost)",
                                         [MCR_KIND_MATERIAL] = "materials"};
static const char *const kind_name[] = {[MCR_KIND_DIRECTIONS] = "sampler, draws directions",
                                        [MCR_KIND_NUMBERS] = "sampler, supplies numbers and stands outside of those that draw directions",
                                        [MCR_KIND_MATERIAL] = "material"};
static const char *const type_title[] = {
    [MCR_TYPE_NUMBER] = "number", [MCR_TYPE_INTEGER] = "whole number", [MCR_TYPE_COLOUR] = "colour", [MCR_TYPE_CHOICE] = "word",
    [MCR_TYPE_MATERIAL] = "material"};

static void print_sets(FILE *to, uint32_t isa_mask)
{
    const char *separator = "";

    for (uint32_t isa = 0; mcr_cpu_isa_name(isa); isa++)
        if (isa_mask & 1u << isa) {
            fprintf(to, "%s%s", separator, mcr_cpu_isa_name(isa));
            separator = " ";
        }
}

void mcr_describe_all(FILE *to, const struct mcr_registry *registry)
{
    const struct mcr_loaded *loaded;
    uint32_t count = mcr_registry_loaded(registry, &loaded), kind = 0;
    size_t width = 0, length;

    for (uint32_t k = 0; k < count; k++) {
        length = strlen(loaded[k].descriptor->name);
        width = length > width ? length : width;
    }
    for (uint32_t k = 0; k < count; k++) {
        const struct mcr_descriptor *descriptor = loaded[k].descriptor;

        if (descriptor->kind != kind)
            fprintf(to, "%s%s\n", kind ? "\n" : "", kind_title[descriptor->kind]);
        kind = descriptor->kind;
        fprintf(to, "  %-*s  %s\n", (int)width, descriptor->name, descriptor->summary);
        fprintf(to, "  %-*s  %s, %s (", (int)width, "", descriptor->version, loaded[k].path);
        print_sets(to, loaded[k].isa_mask);
        fprintf(to, ")\n");
        if (loaded[k].hides)
            fprintf(to, "  %-*s  hides %s\n", (int)width, "", loaded[k].hides);
    }
    if (count == 0)
        fprintf(to, "no plugins found\n");
}

static void print_parameter(FILE *to, const struct mcr_parameter *parameter)
{
    char text[160], word[MCR_MAX_WORD + 1];

    fprintf(to, "    %s: %s", parameter->name, type_title[parameter->type]);
    if (parameter->type == MCR_TYPE_CHOICE) {
        uint32_t count = mcr_choice_count(parameter->choices);

        for (uint32_t k = 0; k < count; k++) {
            mcr_choice_word(parameter->choices, k, word);
            fprintf(to, "%s%s", k == 0 ? ", " : k + 1 == count ? " or " : ", ", word);
        }
    } else if (parameter->type == MCR_TYPE_MATERIAL) {
        fprintf(to, ", by its name");
    } else {
        mcr_range_text(parameter, text, sizeof text);
        fprintf(to, ", %s", text);
    }
    if (parameter->flags & MCR_PARAMETER_REQUIRED) {
        fprintf(to, "; required");
    } else if (parameter->type == MCR_TYPE_MATERIAL) {
        fprintf(to, "; none by default");
    } else {
        mcr_value_text(parameter, parameter->fallback, text, sizeof text);
        fprintf(to, "; default %s", text);
    }
    fprintf(to, "%s\n        %s\n", parameter->flags & MCR_PARAMETER_VARYING ? "; may vary over the surface" : "", parameter->summary);
}

static void describe(FILE *to, const struct mcr_loaded *loaded)
{
    const struct mcr_descriptor *descriptor = loaded->descriptor;

    fprintf(to, "%s: %s\n  kind: %s\n  version: %s\n  licence: %s\n  file: %s\n", descriptor->name, descriptor->summary,
            kind_name[descriptor->kind], descriptor->version, descriptor->licence, loaded->path);
    if (loaded->hides)
        fprintf(to, "  hides: %s\n", loaded->hides);
    fprintf(to, "  instruction sets: ");
    print_sets(to, loaded->isa_mask);
    fprintf(to, "\n  %s\n", descriptor->parameter_count ? "parameters:" : "no parameters");
    for (uint32_t k = 0; k < descriptor->parameter_count; k++)
        print_parameter(to, mcr_descriptor_parameter(descriptor, k));
}

int mcr_describe_word(FILE *to, struct mcr_registry *registry, const char *word)
{
    const struct mcr_loaded *loaded;
    const struct mcr_place nowhere = {0};
    uint32_t count;
    int printed = 0;

    if (!mcr_registry_find(registry, ~0u, word, nowhere, NULL))
        return -1;
    count = mcr_registry_loaded(registry, &loaded);
    for (uint32_t k = 0; k < count; k++)
        if (!strcmp(loaded[k].descriptor->name, word)) {
            if (printed++)
                fputc('\n', to);
            describe(to, &loaded[k]);
        }
    return 0;
}
