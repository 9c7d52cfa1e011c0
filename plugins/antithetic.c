/* SPDX-License-Identifier: Apache-2.0 */
/*
 * antithetic: samples come in pairs; where one has the number u, the other has 1 - u.
 *
 * J. Hammersley, K. Morton, "A new Monte Carlo technique: antithetic variates", Proc. Camb. Phil. Soc. 52, 1956. With samples 2k and 2k + 1 a pair,
 * the variance of a pair's mean is (V + C) / 2, V being the variance of one sample and C the covariance of the two. C <= 0 for what is monotone in every
 * number, and C = -V for what is linear; but C = V for what is symmetric, such as a function of the angle to the normal over a hemisphere drawn through
 * the concentric disk: there pairs cost twice the samples. Hence the choice of the dimensions.
 * The last of an odd number of samples stands alone.
 * On the grid of 53 bits, 1 - u is 1 - 2^-53 - u: both are uniform on it, and stay below 1.
 */
#include <mcrender/sampler.h>

/* Odd: the fractional bits of sqrt 19. */
#define KEY_PAIR UINT64_C(0x5be0cd19137e2179)


static const struct mcr_parameter parameters[] = {
    {.size = sizeof(struct mcr_parameter),
     .type = MCR_TYPE_CHOICE,
     .name = "of",
     .unit = "",
     .choices = "all|pixel|lens|camera|bounces",
     .summary = "Which numbers come in pairs: all; the place in the pixel; that on the lens; both (camera); those of the path's events."},
};

/* Which groups come in pairs: the instance is one of these, not to be changed. */
struct antithetic {
    uint32_t pixel, lens, bounces;
};

static int32_t create(const struct mcr_host *host, struct mcr_context *context, const struct mcr_creation *with, void **instance)
{
    static const struct antithetic all = {1, 1, 1}, pixel = {1, 0, 0}, lens = {0, 1, 0}, camera = {1, 1, 0}, bounces = {0, 0, 1};
    static const struct antithetic *const of[] = {&all, &pixel, &lens, &camera, &bounces};

    (void)host, (void)context;
    *instance = (void *)(uintptr_t)of[(uint32_t)with->values->number[0]];
    return MCR_OK;
}

static uint32_t supplies(const void *instance, uint32_t first, uint32_t count)
{
    const struct antithetic *antithetic = instance;

    return (first < 2 ? antithetic->pixel : first < 8 ? antithetic->lens : antithetic->bounces) ? count : 0;
}

static uint32_t correlated(const void *instance)
{
    (void)instance;
    return 1;
}

/* A pair's number, as it is for the first of the two. */
static void pairs(uint32_t n, const uint64_t *restrict pixel_key, const uint32_t *restrict index, const uint32_t *restrict bounce, uint64_t stride,
                  uint64_t dimension, double *restrict number)
{
    for (uint32_t i = 0; i < n; i++) {
        uint64_t key = mcr_mix64(pixel_key[i] + ((uint64_t)(index[i] >> 1) + 1) * KEY_PAIR);

        number[i] = mcr_number(key, dimension + stride * bounce[i]);
    }
}

static void turn(uint32_t n, const uint32_t *restrict index, double *restrict number)
{
    const double most = 1 - 1.0 / 9007199254740992.0;

    for (uint32_t i = 0; i < n; i++)
        number[i] = index[i] & 1 ? most - number[i] : number[i];
}

/* Where `first` is no bounce's dimension there are no bounces: any array does, times 0. */
static int32_t fill(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_samples *samples,
                    uint32_t first, uint32_t count, double *const *number)
{
    const uint32_t *bounce = first < 8 ? samples->index : samples->bounce, stride = first < 8 ? 0 : 32;

    (void)host, (void)context, (void)instance;
    for (uint32_t k = 0; k < count; k++) {
        pairs(samples->n, samples->pixel_key, samples->index, bounce, stride, (uint64_t)first + k, number[k]);
        turn(samples->n, samples->index, number[k]);
    }
    return MCR_OK;
}

MCR_HIDDEN const struct mcr_numbers_plugin MCR_ISA_NAME(descriptor) = {
    .head = {.size = sizeof(struct mcr_numbers_plugin),
             .kind = MCR_KIND_NUMBERS,
             .isa = MCR_ISA,
             .parameter_count = 1,
             .name = "antithetic",
             .version = "0.9",
             .licence = "Apache-2.0",
             .summary = "samples in pairs, u and 1 - u: less noise from what is monotone in the numbers, up to twice as much from what is symmetric",
             .parameters = parameters},
    .create = create,
    .supplies = supplies,
    .correlated = correlated,
    .fill = fill,
};

MCR_PLUGIN(struct mcr_numbers_plugin, descriptor);
