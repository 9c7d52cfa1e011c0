/* SPDX-License-Identifier: Apache-2.0 */
/* principled: its settings. */
#ifndef PLUGINS_PRINCIPLED_SETTINGS_H
#define PLUGINS_PRINCIPLED_SETTINGS_H

#include <math.h>
#include <mcrender/plugin.h>

/* Parameters, in the order of the table. */
enum {
    BASE, METALLIC, ROUGHNESS, IOR, SPECULAR, SPECULAR_COLOR, CLEARCOAT, CLEARCOAT_ROUGHNESS, SHEEN_COLOR, SHEEN_ROUGHNESS, TRANSMISSION, THIN,
    ATTENUATION_COLOR, ATTENUATION_DISTANCE, PRIORITY, COMPENSATION, PARAMETERS
};
#define CHANNEL(parameter) (3 * (parameter))

#define SHARE(word, text, standard)                                                                                                            \
    {                                                                                                                                          \
        .size = sizeof(struct mcr_parameter), .type = MCR_TYPE_NUMBER, .flags = MCR_PARAMETER_VARYING, .name = word, .unit = "", .summary = text, \
        .fallback = {standard}, .min = 0, .max = 1                                                                                             \
    }
#define COLOUR(word, text, standard, most, how)                                                                                                \
    {                                                                                                                                          \
        .size = sizeof(struct mcr_parameter), .type = MCR_TYPE_COLOUR, .flags = how, .name = word, .unit = "", .summary = text,                \
        .fallback = {standard, standard, standard}, .min = 0, .max = most                                                                      \
    }

static const struct mcr_parameter parameters[PARAMETERS] = {
    [BASE] = COLOUR("base_color", "A metal's reflectance seen from straight above, else the share that is scattered diffusely or tints what is transmitted.",
                    1, 1, MCR_PARAMETER_VARYING),
    [METALLIC] = SHARE("metallic", "How much of the surface is metal: 0 or 1, between them a blend (glTF's own default is 1).", 0),
    [ROUGHNESS] = SHARE("roughness", "Perceptual, as in glTF: its square is GGX's alpha, which other materials here call roughness; 0 is smooth.", 0.5),
    [IOR] = {.size = sizeof(struct mcr_parameter),
             .type = MCR_TYPE_NUMBER,
             .name = "ior",
             .unit = "",
             .summary = "Index of refraction of what is not metal.",
             .fallback = {1.5},
             .min = 1,
             .max = 1e3},
    [SPECULAR] = SHARE("specular", "Scales the reflection of what is not metal, at all angles.", 1),
    [SPECULAR_COLOR] = COLOUR("specular_color", "Scales the reflection of what is not metal seen from straight above, up to 1.", 1, 1e6, MCR_PARAMETER_VARYING),
    [CLEARCOAT] = SHARE("clearcoat", "How much of the surface has a clear coat of index 1.5 on top.", 0),
    [CLEARCOAT_ROUGHNESS] = SHARE("clearcoat_roughness", "The coat's roughness, perceptual like `roughness`; 0 is smooth.", 0),
    [SHEEN_COLOR] = COLOUR("sheen_color", "Colour and strength of the sheen of fibres, as of velvet, under the coat and over all else.", 0, 1, MCR_PARAMETER_VARYING),
    [SHEEN_ROUGHNESS] = SHARE("sheen_roughness", "Perceptual: its square is the alpha of the fibres' distribution; below 0.1 as 0.1.", 0.3),
    [TRANSMISSION] = SHARE("transmission", "How much of what is not metal lets light through instead of scattering it diffusely.", 0),
    [THIN] = {.size = sizeof(struct mcr_parameter),
              .type = MCR_TYPE_CHOICE,
              .name = "thin",
              .unit = "",
              .choices = "no|yes",
              .summary = "Whether a surface that transmits is a thin wall (glTF without its volume extension) and not the boundary of an interior.",
              .fallback = {0}},
    [ATTENUATION_COLOR] = COLOUR("attenuation_color", "Share of light that is left after `attenuation_distance` inside.", 1, 1, MCR_PARAMETER_ABOVE_MIN),
    [ATTENUATION_DISTANCE] = {.size = sizeof(struct mcr_parameter),
                              .type = MCR_TYPE_NUMBER,
                              .flags = MCR_PARAMETER_ABOVE_MIN,
                              .name = "attenuation_distance",
                              .unit = "scene length",
                              .summary = "The distance of `attenuation_color`.",
                              .fallback = {1},
                              .min = 0,
                              .max = HUGE_VAL},
    [PRIORITY] = {.size = sizeof(struct mcr_parameter),
                  .type = MCR_TYPE_NUMBER,
                  .name = "priority",
                  .unit = "",
                  .summary = "Where interiors overlap, that of the highest priority counts.",
                  .fallback = {0},
                  .min = -1e9,
                  .max = 1e9},
    [COMPENSATION] = {.size = sizeof(struct mcr_parameter),
                      .type = MCR_TYPE_CHOICE,
                      .name = "compensation",
                      .unit = "",
                      .choices = "none|kulla-conty",
                      .summary = "Whether the light that meets several facets of metal or of what transmits is lost or comes back in diffuse lobes.",
                      .fallback = {1}},
};

#endif
