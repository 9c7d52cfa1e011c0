/* SPDX-License-Identifier: Apache-2.0 */
/*
 * The tests for bias by simulation: images whose pixels are means of samples, with the variance of the mean estimated from these samples. Images of one
 * expectation must be called "same" in at least the confidence's share of cases; a difference must be seen. The seeds are fixed; a share may miss its bound
 * by 4 binomial standard deviations.
 */
#include "help.h"
#include "metrics/bias.h"

#define SIDE 48u
#define CONFIDENCE 0.95

static const char *const layers[] = {"R", "G", "B", "variance.R", "variance.G", "variance.B", "variance.Y"};

/* How one sample of a pixel is distributed. */
enum noise { NORMAL, RARE, LONG, EDGES, UNMET };

static double sample(enum noise noise, double mean, double covered)
{
    switch (noise) {
    case NORMAL: return mean * (1 + 0.5 * normal());
    case RARE: return uniform() < 0.02 ? mean / 0.02 : 0;           /* a lamp that is hit seldom */
    case LONG: return mean * mcr_exp(2 * normal() - 2);             /* a long tail: lognormal */
    case EDGES: return uniform() < covered ? mean : 0;              /* an edge through some pixels, no noise elsewhere */
    default: return mean * (0.97 + 0.1 * normal()) + (uniform() < 1e-4 ? 300 * mean : 0); /* a glint that few samples do not meet at all */
    }
}

static double covered(uint32_t x, uint32_t y)
{
    uint32_t place = (x * 7919u + y * 104729u) % 100u;
    return place < 10 ? (place + 0.5) / 10 : 1;
}

/*
 * `count` samples a pixel, times a scale, and brighter by 5 % in one tile if `spot`. The lowest quarter is background without noise. Values are stored as
 * 32-bit floats, as in EXR.
 */
static struct mcr_image *rendered(enum noise noise, int count, double scale, int spot)
{
    struct mcr_image *image = image_new(SIDE, SIDE, 7, layers);
    for (uint32_t y = 0; y < SIDE; y++)
        for (uint32_t x = 0; x < SIDE; x++) {
            double *pixel = image->data + 7 * (y * SIDE + x), sum[4] = {0}, squares[4] = {0};
            double mean = scale * (0.2 + 0.8 * x / SIDE) * (spot && x / 8 == 2 && y / 8 == 1 ? 1.05 : 1);
            for (int k = 0; k < count; k++) {
                double v = y >= SIDE * 3 / 4 ? 0.25 * scale : sample(noise, mean, covered(x, y)), value[4] = {v, 0.5 * v, 0.2 * v, 0};
                value[3] = 0.2126 * value[0] + 0.7152 * value[1] + 0.0722 * value[2];
                for (int c = 0; c < 4; c++) sum[c] += value[c], squares[c] += value[c] * value[c];
            }
            for (int c = 0; c < 4; c++) {
                double of_mean = sum[c] / count, variance = (squares[c] / count - of_mean * of_mean) / (count - 1);
                if (c < 3) pixel[c] = (float)of_mean;
                pixel[3 + c] = variance > 1e-13 * of_mean * of_mean ? (float)variance : 0;
            }
        }
    return image;
}

struct shares {
    int different, dependent, covered; /* cases; covered: intervals of the mean difference of luminance that hold 0 */
    double differing;                  /* share of pixels, mean over the cases */
};

static struct shares repeat(enum noise noise, int count_a, int count_r, double scale, int spot, int units, int times)
{
    struct shares shares = {0};
    for (int i = 0; i < times; i++) {
        struct mcr_metrics_options options = {0};
        struct mcr_bias bias;
        char error[256];
        random_state = 1000003u * (unsigned)i + 17u * noise + 1;
        struct mcr_image *a = rendered(noise, count_a, scale, spot), *r = rendered(noise, count_r, 1, 0);
        if (units) a->units = (uint32_t)count_a, r->units = (uint32_t)count_r;
        if (mcr_bias_test(a, r, &options, CONFIDENCE, &bias, error, sizeof error)) exit(99);
        const struct mcr_bias_series *luminance = &bias.series[3];
        shares.different += bias.different;
        shares.dependent += bias.dependent;
        shares.differing += (double)luminance->differing / (double)luminance->tested / times;
        shares.covered += luminance->low <= 0 && luminance->high >= 0;
        mcr_image_destroy(a);
        mcr_image_destroy(r);
    }
    return shares;
}

/* 4 standard deviations of how many of `times` cases have what a share has. */
static double slack(double share, int times)
{
    return 4 * sqrt(share * (1 - share) * times);
}

static void same_things(void)
{
    static const char *const name[] = {"normal noise", "rare bright samples", "a long tail", "edges"};
    static const int counts[][2] = {{16, 16}, {4, 64}, {2, 2}, {32, 8}};
    const int times = 60;
    for (int noise = NORMAL; noise <= EDGES; noise++)
        for (int k = 0; k < 4; k++) {
            struct shares s = repeat(noise, counts[k][0], counts[k][1], 1, 0, k % 2, times);
            printf("# of %d: different %d, interval holds 0 in %d; pixels beyond %.4f\n", times, s.different, s.covered, s.differing);
            ok(s.different <= (1 - CONFIDENCE) * times + slack(CONFIDENCE, times), "%s, %d and %d samples: the same in at least 95 %%", name[noise],
               counts[k][0], counts[k][1]);
            ok(s.covered >= CONFIDENCE * times - slack(CONFIDENCE, times), "and the interval holds 0 as often");
            ok(s.dependent == 0, "never called dependent");
        }
}

/* Where normal noise comes in equal numbers of samples, the share of pixels is the one expected: of 1,728 pixels, 50 times. */
static void pixel_shares(void)
{
    const int times = 50, pixels = SIDE * SIDE * 3 / 4;
    for (int count = 2; count <= 8; count *= 2)
        for (int units = 0; units < 2; units++) {
            struct shares s = repeat(NORMAL, count, count, 1, 0, units, times);
            /* Luminance is normal. The degrees of freedom by scatter are off by some per cent: 5 % of 2 of them are 0.0016 of the share. */
            double bound = slack(0.05, times * pixels) / (times * pixels) + (units ? 0 : 0.002);
            ok(fabs(s.differing - 0.05) <= bound, "%d samples%s: %.4f of the pixels beyond, 0.05 expected", count, units ? ", told" : "", s.differing);
        }
}

/* A low variance because the light was not met is no sign of a difference: the better image foretells it. */
static void unmet_light(void)
{
    const int times = 60;
    struct shares s = repeat(RARE, 4, 400, 1, 0, 1, 10);
    ok(s.differing <= 0.05, "rare bright samples, 4 and 400: %.4f of the pixels beyond, at most 0.05 expected", s.differing);
    s = repeat(UNMET, 2, 60, 1, 0, 1, times);
    printf("# of %d: different %d, interval holds 0 in %d; pixels beyond %.4f\n", times, s.different, s.covered, s.differing);
    ok(s.different <= (1 - CONFIDENCE) * times + slack(CONFIDENCE, times), "a glint that few samples do not meet: the same in at least 95 %%");
}

static void different_things(void)
{
    struct shares s = repeat(NORMAL, 100, 100, 1.01, 0, 1, 20);
    ok(s.different == 20, "brighter by 1 %%: different");
    s = repeat(RARE, 400, 400, 1.2, 0, 1, 10);
    ok(s.different == 10, "rare bright samples, brighter by 20 %%: different");
    s = repeat(NORMAL, 256, 256, 1, 1, 1, 10);
    ok(s.different == 10, "one tile of 8 x 8 brighter by 5 %%: different");
    s = repeat(EDGES, 4, 4, 1.01, 0, 0, 10);
    ok(s.different == 10, "no noise but at edges, brighter by 1 %%: different");
}

/* One comparison; the result must not depend on how it is asked. */
static struct mcr_bias one(const struct mcr_image *a, const struct mcr_image *r, const struct mcr_metrics_options *options)
{
    struct mcr_bias bias;
    char error[256];
    if (mcr_bias_test(a, r, options, CONFIDENCE, &bias, error, sizeof error)) exit(99);
    return bias;
}

static void silence(void)
{
    struct mcr_metrics_options options = {0}, crop = {.has_crop = 1, .crop = {0, SIDE * 3 / 4, SIDE, SIDE}};
    struct mcr_image *a = image_flat(20, 20, 7, layers, 0), *r = image_flat(20, 20, 7, layers, 0);
    for (size_t i = 0; i < 400; i++)
        for (int c = 0; c < 3; c++) a->data[7 * i + c] = r->data[7 * i + c] = 0.3;
    struct mcr_bias bias = one(a, r, &options);
    ok(!bias.different && bias.p == 1 && bias.series[0].tested == 0 && bias.series[0].silent_same == 400, "images without noise that agree");
    r->data[7 * 210 + 1] = 0.30000001;
    ok(!one(a, r, &options).different, "the rounding of a float is no difference");
    r->data[7 * 210 + 1] = 0.3001;
    bias = one(a, r, &options);
    ok(bias.different && bias.p == 0 && bias.series[1].silent_differing == 1 && bias.series[1].differing == 1 && bias.series[0].silent_differing == 0,
       "one pixel that does not");
    mcr_image_destroy(a);
    mcr_image_destroy(r);
    random_state = 5;
    a = rendered(NORMAL, 16, 1, 0), r = rendered(NORMAL, 16, 1.001, 0);
    bias = one(a, r, &options);
    ok(bias.different && bias.series[2].silent_differing == SIDE * SIDE / 4, "a background that differs by 0.1 %% beside noise of 12 %%");
    ok(one(a, r, &crop).different, "the same in a crop");
    mcr_image_destroy(a);
    mcr_image_destroy(r);
}

static void dependence(void)
{
    struct mcr_metrics_options options = {0};
    random_state = 5;
    struct mcr_image *a = rendered(LONG, 16, 1, 0), *r = rendered(LONG, 16, 1, 0);
    struct mcr_bias bias = one(a, a, &options);
    ok(bias.dependent && !bias.different, "an image and itself: the same, and dependent");
    ok(!one(a, r, &options).dependent, "two seeds: independent");
    a->units = r->units = 16;
    bias = one(a, r, &options);
    ok(close_to(bias.series[0].degrees, 30, 1), "degrees of freedom as the files say: 15 and 15"); /* 30 where both have the same variance */
    mcr_image_destroy(a);
    mcr_image_destroy(r);
}

static void odd_inputs(void)
{
    static const char *const of_grey[] = {"Y", "variance.Y"};
    struct mcr_metrics_options options = {0};
    struct mcr_image *a = image_flat(1, 1, 2, of_grey, 0.5), *plain = image_flat(4, 4, 3, rgb, 1);
    struct mcr_bias bias = one(a, a, &options);
    ok(mcr_bias_known(a) && !mcr_bias_known(plain), "variance layers are known by their names");
    ok(bias.series_count == 1 && !bias.different && !strcmp(bias.series[0].name, "Y"), "a single grey pixel");
    a->data[1] = MCR_NAN;
    bias = one(a, a, &options);
    ok(bias.series[0].tested == 0 && !bias.different, "a variance that is NaN: not tested");
    a->data[1] = -1;
    ok(one(a, a, &options).series[0].tested == 0, "a negative one, too");
    mcr_image_destroy(a);
    mcr_image_destroy(plain);
    a = rendered(NORMAL, 4, 1, 0);
    ok(one(a, a, &(struct mcr_metrics_options){.encoding = MCR_ENCODING_SRGB8}).series_count == 4, "codes do not matter: values are linear");
    mcr_image_destroy(a);
}

int main(void)
{
    same_things();
    pixel_shares();
    unmet_light();
    different_things();
    silence();
    dependence();
    odd_inputs();
    return tap_done();
}
