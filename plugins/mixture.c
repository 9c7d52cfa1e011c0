/* SPDX-License-Identifier: Apache-2.0 */
/*
 * mixture: draws from one of its children, chosen by weight, and tells the weighted sum of their densities. Number 0 chooses;
 * the children share the numbers from 1 on, since only one of them is used. Each child is told in which lanes it was chosen; whether
 * it draws in the others too is its own affair: a select keeps what was chosen. A child of weight 0 is never called.
 */
#include <mcrender/sampler.h>
#include <stdlib.h>

struct mixture {
    uint32_t count; /* children of positive weight */
    struct mcr_technique technique;
    const struct mcr_child *child[MCR_MAX_CHILDREN];
    double weight[MCR_MAX_CHILDREN]; /* sum to 1 */
    double from[MCR_MAX_CHILDREN];   /* child k is chosen where from[k] <= number 0 < from[k+1]; from[0] = 0, the last goes to 1 */
};

/* Doubles to one array of scratch: a multiple of 8 keeps every array aligned and padded. */
static uint64_t padded(uint32_t n)
{
    return ((uint64_t)n + 7) / 8 * 8;
}

static int32_t refuse(const struct mcr_host *host, struct mcr_context *context, const char *text)
{
    host->report(host, context, MCR_REPORT_ERROR, text);
    return MCR_E_INVALID;
}

/* Takes child k in if its weight is positive. Its one technique must draw directions. */
static int32_t add_child(const struct mcr_host *host, struct mcr_context *context, const struct mcr_creation *with, uint32_t k, double weight,
                         struct mixture *mixture)
{
    struct mcr_technique technique[MCR_MAX_TECHNIQUES];
    uint32_t count = MCR_MAX_TECHNIQUES;
    char text[] = "every sampler inside 'mixture' must have exactly one technique, which draws directions; this is not so for number ..";
    char *digits = text + sizeof text - 3;
    int32_t status;

    for (uint32_t t = 0; t < MCR_MAX_TECHNIQUES; t++)
        technique[t] = (struct mcr_technique){.size = sizeof *technique};
    status = host->child_techniques(host, context, with->child[k], technique, &count);
    if (status)
        return status;
    if (count != 1 || technique[0].kind != MCR_TECHNIQUE_DIRECTION) {
        if (k + 1 >= 10)
            *digits++ = '1';
        *digits++ = (char)('0' + (k + 1) % 10);
        *digits = 0;
        return refuse(host, context, text);
    }
    if (!(weight > 0))
        return MCR_OK;
    mixture->child[mixture->count] = with->child[k];
    mixture->weight[mixture->count++] = weight;
    mixture->technique.covers |= technique[0].covers;
    if (mixture->technique.dimensions < 1 + technique[0].dimensions)
        mixture->technique.dimensions = 1 + technique[0].dimensions;
    return MCR_OK;
}

static int32_t create(const struct mcr_host *host, struct mcr_context *context, const struct mcr_creation *with, void **instance)
{
    struct mixture *mixture;
    double largest = 0, sum = 0;
    int32_t status = MCR_OK;

    if (with->child_count == 0)
        return refuse(host, context, "'mixture' needs samplers inside it, as in mixture(cosine 1, light 1)");
    for (uint32_t k = 0; k < with->child_count; k++)
        largest = with->weight[k] > largest ? with->weight[k] : largest;
    if (!(largest > 0))
        return refuse(host, context, "all weights of 'mixture' are 0, expected at least one above 0");
    for (uint32_t k = 0; k < with->child_count; k++) /* relative to the largest: neither 1e308 nor 1e-308 is lost */
        sum += with->weight[k] / largest;
    mixture = calloc(1, sizeof *mixture);
    if (!mixture)
        return MCR_E_NOMEM;
    mixture->technique.kind = MCR_TECHNIQUE_DIRECTION;
    mixture->technique.continues = 1;
    for (uint32_t k = 0; k < with->child_count && status == MCR_OK; k++)
        status = add_child(host, context, with, k, with->weight[k] / largest / sum, mixture);
    if (status) {
        free(mixture);
        return status;
    }
    for (uint32_t k = 1; k < mixture->count; k++)
        mixture->from[k] = mixture->from[k - 1] + mixture->weight[k - 1];
    *instance = mixture;
    return MCR_OK;
}

static void destroy(void *instance)
{
    free(instance);
}

static int32_t techniques(const struct mcr_host *host, struct mcr_context *context, const void *instance, struct mcr_technique *technique,
                          uint32_t *count)
{
    const struct mixture *mixture = instance;

    (void)host, (void)context;
    technique[0].kind = mixture->technique.kind;
    technique[0].covers = mixture->technique.covers;
    technique[0].continues = mixture->technique.continues;
    technique[0].dimensions = mixture->technique.dimensions;
    *count = 1;
    return MCR_OK;
}

/* `draw` holds one child's directions and the lanes that want it, then densities; `density` and `mass` one array. */
static uint64_t scratch_bytes(const void *instance, uint32_t n)
{
    (void)instance;
    return 4 * padded(n) * sizeof(double);
}

static void want_lanes(uint32_t n, double from, double to, const double *restrict number, double *restrict wanted)
{
    for (uint32_t i = 0; i < n; i++)
        wanted[i] = ((number[i] >= from) & (number[i] < to)) ? 1.0 : 0.0;
}

static void multiply_lanes(uint32_t n, const double *restrict factor, double *restrict value)
{
    for (uint32_t i = 0; i < n; i++)
        value[i] *= factor[i];
}

__attribute__((noinline)) static void select_lanes(uint32_t n, const double *restrict wanted, const double *restrict cx, const double *restrict cy,
                         const double *restrict cz, double *restrict x, double *restrict y, double *restrict z)
{
    for (uint32_t i = 0; i < n; i++) {
        int chosen = wanted[i] != 0;
        double kx = x[i], ky = y[i], kz = z[i];
        x[i] = chosen ? cx[i] : kx;
        y[i] = chosen ? cy[i] : ky;
        z[i] = chosen ? cz[i] : kz;
    }
}

static void scale_lanes(uint32_t n, double weight, double *restrict sum)
{
    for (uint32_t i = 0; i < n; i++)
        sum[i] = weight * sum[i];
}

static void add_lanes(uint32_t n, double weight, const double *restrict term, double *restrict sum)
{
    for (uint32_t i = 0; i < n; i++)
        sum[i] += weight * term[i];
}

static int32_t density(const struct mcr_host *host, struct mcr_context *context, const void *instance, uint32_t technique,
                       const struct mcr_points *at, const struct mcr_directions *toward, double *density)
{
    const struct mixture *mixture = instance;
    double *term = host->scratch(host, context);
    int32_t status = host->child_density(host, context, mixture->child[0], 0, at, toward, density);

    (void)technique;
    scale_lanes(at->n, mixture->weight[0], density);
    for (uint32_t k = 1; k < mixture->count && status == MCR_OK; k++) {
        status = host->child_density(host, context, mixture->child[k], 0, at, toward, term);
        add_lanes(at->n, mixture->weight[k], term, density);
    }
    return status;
}

/* Number 0 tells the child. The density is asked for once, at what was chosen. */
static int32_t draw(const struct mcr_host *host, struct mcr_context *context, const void *instance, uint32_t technique,
                    const struct mcr_points *at, const double *const *number, const struct mcr_directions *out, double *chosen_density)
{
    const struct mixture *mixture = instance;
    double *scratch = host->scratch(host, context);
    uint64_t stride = padded(at->n);
    struct mcr_directions drawn = {sizeof drawn, at->n, scratch, scratch + stride, scratch + 2 * stride};
    double *wanted = scratch + 3 * stride;
    struct mcr_points some = *at;
    int32_t status = MCR_OK;

    some.wanted = wanted;
    for (uint32_t k = 0; k < mixture->count && status == MCR_OK; k++) {
        want_lanes(at->n, mixture->from[k], k + 1 < mixture->count ? mixture->from[k + 1] : 2, number[0], wanted);
        if (at->wanted)
            multiply_lanes(at->n, at->wanted, wanted);
        status = host->child_draw(host, context, mixture->child[k], 0, &some, number + 1, k ? &drawn : out, NULL);
        if (k)
            select_lanes(at->n, wanted, drawn.x, drawn.y, drawn.z, out->x, out->y, out->z);
    }
    if (status || !chosen_density)
        return status;
    return density(host, context, instance, technique, at, out, chosen_density);
}

static int32_t mass(const struct mcr_host *host, struct mcr_context *context, const void *instance, uint32_t technique,
                    const struct mcr_points *at, double *mass)
{
    const struct mixture *mixture = instance;
    double *term = host->scratch(host, context);
    int32_t status = host->child_mass(host, context, mixture->child[0], 0, at, mass);

    (void)technique;
    scale_lanes(at->n, mixture->weight[0], mass);
    for (uint32_t k = 1; k < mixture->count && status == MCR_OK; k++) {
        status = host->child_mass(host, context, mixture->child[k], 0, at, term);
        add_lanes(at->n, mixture->weight[k], term, mass);
    }
    return status;
}

MCR_HIDDEN const struct mcr_directions_plugin MCR_ISA_NAME(descriptor) = {
    .head = {.size = sizeof(struct mcr_directions_plugin),
             .kind = MCR_KIND_DIRECTIONS,
             .isa = MCR_ISA,
             .name = "mixture",
             .version = "0.9",
             .licence = "Apache-2.0",
             .summary = "one of up to 16 weighted samplers at random, with the weighted sum as density"},
    .create = create,
    .destroy = destroy,
    .techniques = techniques,
    .scratch_bytes = scratch_bytes,
    .draw = draw,
    .density = density,
    .mass = mass,
};

MCR_PLUGIN(struct mcr_directions_plugin, descriptor);
