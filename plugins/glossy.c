/* SPDX-License-Identifier: Apache-2.0 */
/*
 * glossy: a diffuse base under a clear dielectric coat, smooth (a mirror-like lobe) or of GGX microfacets, on both sides; plastic, varnish, polish.
 *
 *     f = coat + albedo / pi  (1 - E(o)) (1 - E(i)) / (n^2 (1 - albedo k))        k = 1 - (1 - <E>) / n^2
 *
 * E is the coat's directional albedo and < > a mean weighted by the cosine: what the coat does not reflect reaches the base and leaves it again, after any
 * number of reflections between base and coat, of which the coat keeps the share k (Egan and Hilgeman, "Optical properties of inhomogeneous materials",
 * 1979, equation 4.2): colours become deeper, white loses nothing, and f is reciprocal. A smooth coat has E of Fresnel's formulas. A rough
 * one has the share that is reflected once, 1 - `lost`, times Fresnel's mean over that, which `create` integrates over visible normals at 20 x 24 Chebyshev
 * nodes. Together these polynomials err by less than 2e-4 for indices up to 4, by 4e-4 up to 20, and by a per cent at the horizon for the largest.
 */
#include <mcrender/math.h>
#include <mcrender/microfacet.h>
#include <stdlib.h>

enum { ALBEDO, INDEX, ROUGHNESS, PARAMETERS };
#define CHANNEL(parameter) (3 * (parameter))

static const struct mcr_parameter parameters[PARAMETERS] = {
    [ALBEDO] = {.size = sizeof(struct mcr_parameter),
                .type = MCR_TYPE_COLOUR,
                .flags = MCR_PARAMETER_VARYING,
                .name = "albedo",
                .unit = "",
                .summary = "Share of the light that the base scatters at once, without the coat.",
                .fallback = {0.5, 0.5, 0.5},
                .min = 0,
                .max = 1},
    [INDEX] = {.size = sizeof(struct mcr_parameter),
               .type = MCR_TYPE_NUMBER,
               .name = "index",
               .unit = "",
               .summary = "Index of refraction of the coat, relative to the medium outside.",
               .fallback = {1.5},
               .min = 1,
               .max = 1e3},
    [ROUGHNESS] = {.size = sizeof(struct mcr_parameter),
                   .type = MCR_TYPE_NUMBER,
                   .flags = MCR_PARAMETER_VARYING,
                   .name = "roughness",
                   .unit = "",
                   .summary = "The alpha of the coat's GGX, the width of the slopes' distribution; 0 is smooth.",
                   .fallback = {0.1},
                   .min = 0,
                   .max = 1},
};

#define ROWS 20
#define COLUMNS 24
#define LOST_ROWS 18
#define LOST_COLUMNS 12

/*
 * 1 - E of GGX that reflects all light: row j holds the coefficients of u^j, powers of y; u and y as in places_lanes. Through midpoint sums over
 * 96 x 400 visible normals at Chebyshev nodes; errs by less than 1e-4 for all alpha.
 */
static const double lost[LOST_ROWS][LOST_COLUMNS] = {
    {0.09613304076, 0.1361409839, 0.1823269006, 0.08428976452, -0.01960419331, -0.02982559698,
     -0.003170341102, 0.0102175799, -0.001001952859, -0.008932537534, 0.0009674877397, 0.003464068492},
    {0.1700909021, 0.1581632867, 0.2133901393, 0.08942129712, -0.07296241127, -0.08301214335,
     0.05963678933, 0.07833904625, -0.09853847877, -0.09969894422, 0.04587486741, 0.04562688403},
    {0.04347883351, -0.04657539405, -0.04789960939, 0.02297517854, 0.06273111599, -0.05282842162,
     -0.2351699551, -0.1369565143, 0.1966895708, 0.1868478599, -0.06183259571, -0.071294008},
    {-0.09494379193, -0.04624587364, -0.1393539052, 0.01248560995, 1.082817731, 0.7471621057,
     -3.279910781, -2.965700594, 3.871291583, 3.819398181, -1.581485613, -1.622694609},
    {-0.1860813074, 0.1763124248, 0.3343494798, -0.1510877124, -1.356938154, -1.221827895,
     2.973760342, 4.197811474, -3.102132044, -4.830411024, 1.239672473, 1.929248117},
    {-0.2644588695, 0.222051234, 1.649394719, 1.37876573, -12.18077581, -14.768061,
     35.30740647, 44.00223133, -41.64290894, -51.55317555, 17.07979113, 20.91779526},
    {0.01167375571, -0.5217932699, -1.575304313, 0.3367832911, 9.782366352, 14.16982959,
     -24.35978794, -45.19816436, 27.12520541, 51.69306349, -11.17038138, -20.55763429},
    {0.5299197335, -0.198795113, -7.916764837, -13.18518463, 62.97956462, 108.8137911,
     -184.7302196, -298.1479248, 218.3762906, 333.4183019, -89.4277936, -131.0981372},
    {-0.4612604705, 2.149259466, 7.083643202, 1.687094111, -38.83101006, -68.21971218,
     96.17182109, 204.6215102, -108.6858665, -231.1229339, 45.40102182, 91.5634787},
    {-1.763780347, 0.3803783123, 23.92758633, 54.99781941, -181.8380764, -406.962207,
     530.018255, 1058.758227, -626.2106459, -1147.706135, 256.2954856, 441.7257451},
    {1.487367215, -3.190493893, -15.70904925, -8.129211747, 80.65394275, 153.942934,
     -202.4741658, -453.4359876, 233.4944987, 514.1491483, -98.87350409, -204.7196437},
    {4.190111689, 0.3697239643, -42.37090926, -120.4271736, 302.2855557, 825.7044573,
     -878.6611424, -2080.058042, 1041.799708, 2213.10938, -427.4418541, -840.9211052},
    {-1.326196198, 1.295572548, 18.31471474, 12.2160006, -93.36784966, -179.2531084,
     239.8958039, 532.3514472, -281.2529169, -611.2703281, 120.0150707, 245.5270277},
    {-4.686416125, -2.822053869, 42.75884062, 142.4353711, -290.5388079, -924.591346,
     846.9194338, 2284.972036, -1010.46058, -2405.824208, 416.2062417, 907.5308888},
    {0.3555551224, 0.5865234842, -11.04678444, -7.918582032, 57.34356594, 105.5196262,
     -150.3633829, -320.2968816, 177.9459729, 373.5663434, -76.09213256, -151.4553341},
    {2.455386066, 3.238662196, -22.99206506, -86.25361697, 150.9587616, 538.8704738,
     -442.5365775, -1317.352087, 531.6121845, 1379.468521, -219.8386744, -518.3370367},
    {0.02146051072, -0.4079740901, 2.717771462, 1.909640532, -14.47635202, -25.00080825,
     38.52567204, 78.03815336, -45.77773582, -92.45452651, 19.55356189, 37.80539395},
    {-0.4937806322, -1.124922258, 5.12366723, 21.01025704, -32.88525696, -127.8781,
     97.03473439, 310.8665214, -117.3044658, -324.7265324, 48.67502685, 121.784493},
};

/* `mean[j]` holds the coefficients of x^j, powers of y, of Fresnel's mean; x and y as in places_lanes. `whole`: <E> in y. */
struct coat {
    double index, smooth;
    double mean[ROWS][COLUMNS], whole[COLUMNS];
};

/* ---- E ---- */

/* A row of the polynomials in y, with y12 = y^12. */
MCR_INLINE double row24(const double *c, double y, double y12) { return mcr_row12_(c + 12, y) * y12 + mcr_row12_(c, y); }

static void powers_lanes(uint32_t n, const double *alpha, double *restrict y, double *restrict y12)
{
    for (uint32_t i = 0; i < n; i++) {
        double value = 2 * sqrt(alpha[i]) - 1, y4 = value * value * (value * value);
        y[i] = value;
        y12[i] = y4 * y4 * y4;
    }
}

/*
 * Where a cosine c is, in [-1, 1]. Toward the horizon, what depends on c / alpha changes quickly, and all that does elsewhere slowly: x grows as sqrt(c), and
 * linearly where c is far below alpha; u tells c / (alpha tangent) alone.
 */
static void places_lanes(uint32_t n, const double *alpha, uint32_t stride, const double *cosine, double *restrict x, double *restrict u)
{
    for (uint32_t i = 0; i < n; i++) {
        double a = alpha[i * stride], c = mcr_within_unit_(cosine[i]), sine2 = (1 - c) * (1 + c), spread = sqrt(c * c + a * a * sine2);
        x[i] = 2 * (c * sqrt((1 + a) / (spread + a))) - 1;
        u[i] = 2 * sqrt(c / (c + a * sqrt(sine2))) - 1;
    }
}

/* p = p * x + a row, whose y is the same in all lanes where the stride is 0. */
static void mean_step(uint32_t n, const double *c, const double *y, const double *y12, uint32_t stride, const double *x, double *restrict p)
{
    double same = row24(c, y[0], y12[0]);

    if (stride)
        for (uint32_t i = 0; i < n; i++)
            p[i] = p[i] * x[i] + row24(c, y[i], y12[i]);
    else
        for (uint32_t i = 0; i < n; i++)
            p[i] = p[i] * x[i] + same;
}

static void lost_step(uint32_t n, const double *c, const double *y, uint32_t stride, const double *u, double *restrict p)
{
    double same = mcr_row12_(c, y[0]);

    if (stride)
        for (uint32_t i = 0; i < n; i++)
            p[i] = p[i] * u[i] + mcr_row12_(c, y[i]);
    else
        for (uint32_t i = 0; i < n; i++)
            p[i] = p[i] * u[i] + same;
}

static void product_lanes(uint32_t n, const double *gone, double *restrict e)
{
    for (uint32_t i = 0; i < n; i++)
        e[i] = mcr_within_unit_(e[i]) * (1 - mcr_within_unit_(gone[i]));
}

/* The arrays over the lanes that E is computed with; alpha, y and y12 have stride 0 or 1. */
struct room {
    const double *alpha;
    uint32_t stride;
    double *y, *y12, *x, *u, *gone;
};

static void rough_albedo(const struct coat *coat, uint32_t n, const struct room *r, const double *cosine, double *e)
{
    places_lanes(n, r->alpha, r->stride, cosine, r->x, r->u);
    mcr_fill_lanes(n, 0, e);
    for (int j = ROWS - 1; j >= 0; j--)
        mean_step(n, coat->mean[j], r->y, r->y12, r->stride, r->x, e);
    mcr_fill_lanes(n, 0, r->gone);
    for (int j = LOST_ROWS - 1; j >= 0; j--)
        lost_step(n, lost[j], r->y, r->stride, r->u, r->gone);
    product_lanes(n, r->gone, e);
}

MCR_INLINE double smooth_albedo(double index, double c)
{
    double q;
    return mcr_fresnel_dielectric(mcr_within_unit_(c), index, &q);
}

static void smooth_lanes(uint32_t n, double index, const double *cosine, double *restrict e)
{
    for (uint32_t i = 0; i < n; i++)
        e[i] = smooth_albedo(index, cosine[i]);
}

static void albedo_lanes(const struct coat *coat, uint32_t n, const struct room *r, const double *cosine, double *e)
{
    if (coat->smooth != 0)
        smooth_lanes(n, coat->index, cosine, e);
    else
        rough_albedo(coat, n, r, cosine, e);
}

/* ---- create ---- */

static double node(int k, int n)
{
    return mcr_cos(MCR_PI * (k + 0.5) / n);
}

/* Coefficients of powers of the polynomial through n <= COLUMNS values at the nodes. */
static void interpolate(const double *value, int n, double *c)
{
    double before[COLUMNS] = {1}, here[COLUMNS] = {0, 1}, next[COLUMNS];

    for (int k = 0; k < n; k++)
        c[k] = 0;
    for (int k = 0; k < n; k++) {
        double sum = 0;
        for (int j = 0; j < n; j++)
            sum += value[j] * mcr_cos(MCR_PI * k * (j + 0.5) / n);
        sum *= (k ? 2.0 : 1.0) / n;
        for (int i = 0; i < n; i++)
            c[i] += sum * (k ? here[i] : before[i]);
        for (int i = 0; i < n && k; i++)
            next[i] = (i ? 2 * here[i - 1] : 0) - before[i];
        for (int i = 0; i < n && k; i++)
            before[i] = here[i], here[i] = next[i];
    }
}

#define RINGS 48
#define SPOKES 64

/* What one ring of visible normals reflects once, and of that Fresnel's share; `sine` and `turn` of the spokes' angles. */
static void ring_lanes(double index, double alpha, double cosine, double rest, const double *sine, const double *turn, double *restrict all,
                       double *restrict reflected)
{
    double horizontal = sqrt((1 - cosine) * (1 + cosine)), spread = mcr_ggx_spread(alpha, alpha, mcr_vector(horizontal, 0, cosine));
    double sx = alpha * horizontal / spread, p = 1 + cosine / spread, radius = sqrt(1 - rest) * sqrt(p * (2 - (1 - rest) * p));

    for (int j = 0; j < SPOKES; j++) {
        double mx = alpha * (radius * turn[j] + sx), my = alpha * radius * sine[j], mz = p * rest, length = sqrt(mx * mx + my * my + mz * mz), q;
        double c = (horizontal * mx + cosine * mz) / length, in = 2 * c * mz / length - cosine, above = in > 0 ? in : 0;
        double value = above * (cosine + spread) / (above * spread + cosine * sqrt(above * above + alpha * alpha * (1 - above * above)));

        all[j] = value;
        reflected[j] = value * mcr_fresnel_dielectric(c < 1 ? c : 1, index, &q);
    }
}

/* Fresnel's mean over the reflected light seen at this cosine, by midpoints in the cap's azimuth and in the cube root of 1 - radius^2. */
static double mean_reflectance(double index, double alpha, double cosine, const double *sine, const double *turn)
{
    double all = 0, reflected = 0, value[SPOKES], share[SPOKES];

    for (int i = 0; i < RINGS; i++) {
        double t = (i + 0.5) / RINGS;
        ring_lanes(index, alpha, cosine, t * t * t, sine, turn, value, share);
        for (int j = 0; j < SPOKES; j++) {
            all += t * t * value[j];
            reflected += t * t * share[j];
        }
    }
    return all > 0 ? reflected / all : 1;
}

/* 2 integral E c dc by midpoints in the cube root of c. */
static double whole_albedo(const struct coat *coat, double alpha)
{
    enum { STEPS = 512 };
    double cosine[STEPS], e[STEPS], x[STEPS], u[STEPS], gone[STEPS], y, y12, sum = 0;
    struct room room = {&alpha, 0, &y, &y12, x, u, gone};

    for (int k = 0; k < STEPS; k++) {
        double z = (k + 0.5) / STEPS;
        cosine[k] = z * z * z;
    }
    powers_lanes(1, &alpha, &y, &y12);
    albedo_lanes(coat, STEPS, &room, cosine, e);
    for (int k = 0; k < STEPS; k++) {
        double z = (k + 0.5) / STEPS;
        sum += e[k] * 6 * cosine[k] * z * z;
    }
    return sum / STEPS;
}

static void fill_mean(struct coat *coat)
{
    double value[ROWS], rows[COLUMNS][ROWS], column[COLUMNS], sine[SPOKES], turn[SPOKES];

    for (int j = 0; j < SPOKES; j++)
        mcr_sincos_turns(0.5 * (j + 0.5) / SPOKES, &sine[j], &turn[j]);
    for (int i = 0; i < COLUMNS; i++) {
        double y = 0.5 + 0.5 * node(i, COLUMNS), alpha = y * y;
        for (int j = 0; j < ROWS; j++) {
            double x = 0.5 + 0.5 * node(j, ROWS), spread = alpha + (1 - alpha) * x * x;
            double c = sqrt((spread - alpha) * (spread + alpha) / ((1 - alpha) * (1 + alpha)));
            value[j] = mean_reflectance(coat->index, alpha, c < 1 ? c : 1, sine, turn);
        }
        interpolate(value, ROWS, rows[i]);
    }
    for (int j = 0; j < ROWS; j++) {
        for (int i = 0; i < COLUMNS; i++)
            column[i] = rows[i][j];
        interpolate(column, COLUMNS, coat->mean[j]);
    }
}

static void fill(struct coat *coat)
{
    double column[COLUMNS];

    if (coat->smooth == 0)
        fill_mean(coat);
    for (int i = 0; i < COLUMNS; i++) {
        double y = 0.5 + 0.5 * node(i, COLUMNS);
        column[i] = whole_albedo(coat, y * y);
    }
    interpolate(column, COLUMNS, coat->whole);
}

static int32_t create(const struct mcr_host *host, struct mcr_context *context, const struct mcr_creation *with, void **instance)
{
    struct coat *coat = calloc(1, sizeof *coat);

    (void)host, (void)context;
    *instance = coat;
    if (!coat)
        return MCR_E_NOMEM;
    coat->index = with->values->number[CHANNEL(INDEX)];
    coat->smooth = with->values->number[CHANNEL(ROUGHNESS)] > 0 ? 0 : 1;
    fill(coat);
    return MCR_OK;
}

static void destroy(void *instance)
{
    free(instance);
}

static int32_t traits(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_values *values,
                      struct mcr_material_traits *traits)
{
    (void)host, (void)context, (void)instance;
    traits->does = MCR_MATERIAL_REFLECTS | (values->number[CHANNEL(ROUGHNESS)] > 0 ? 0 : MCR_MATERIAL_DELTA);
    return MCR_OK;
}

/* Arrays of scratch, of mcr_padded(n) doubles each. TANGENT is 3. */
enum { ALPHA, SPECULAR, BASE, SHARE, RED, GREEN, BLUE, WHOLE, Y, Y12, X, U, GONE, COSINE, OUT, IN, TANGENT, ARRAYS = TANGENT + 3 };

static uint64_t scratch_bytes(const void *instance, uint32_t n)
{
    (void)instance;
    return ARRAYS * mcr_padded(n) * sizeof(double);
}

/* ---- lanes ---- */

static const double *alpha_lanes(const struct mcr_points *at, const struct mcr_inputs *inputs, double *restrict room)
{
    const double *alpha = inputs->channel[CHANNEL(ROUGHNESS)];
    uint32_t stride = inputs->stride[CHANNEL(ROUGHNESS)];

    for (uint32_t i = 0; i < at->n; i++) {
        double a = alpha[i * stride];
        room[i] = a > MCR_GGX_LEAST ? a : MCR_GGX_LEAST;
    }
    return room;
}

/* What E needs of the lanes' roughness; the arrays are the scratch's. */
static struct room room_of(const struct mcr_points *at, const struct mcr_inputs *inputs, const double *alpha, double *room)
{
    const uint64_t n = mcr_padded(at->n);
    uint32_t stride = inputs->stride[CHANNEL(ROUGHNESS)];

    powers_lanes(stride ? at->n : 1, alpha, room + Y * n, room + Y12 * n);
    return (struct room){alpha, stride, room + Y * n, room + Y12 * n, room + X * n, room + U * n, room + GONE * n};
}

static void cosine_lanes(const struct mcr_points *at, const double *x, const double *y, const double *z, double *restrict cosine)
{
    const double *nx = at->nx, *ny = at->ny, *nz = at->nz;

    for (uint32_t i = 0; i < at->n; i++)
        cosine[i] = nx[i] * x[i] + ny[i] * y[i] + nz[i] * z[i];
}

/* E of the outgoing directions. */
static const double *out_lanes(const struct coat *coat, const struct mcr_points *at, const struct room *r, double *room)
{
    const uint64_t n = mcr_padded(at->n);

    cosine_lanes(at, at->ox, at->oy, at->oz, room + COSINE * n);
    albedo_lanes(coat, at->n, r, room + COSINE * n, room + OUT * n);
    return room + OUT * n;
}

static const double *whole_lanes(const struct coat *coat, const struct mcr_points *at, const struct room *r, double *restrict whole)
{
    double same = mcr_within_unit_(row24(coat->whole, r->y[0], r->y12[0]));

    if (r->stride)
        for (uint32_t i = 0; i < at->n; i++)
            whole[i] = mcr_within_unit_(row24(coat->whole, r->y[i], r->y12[i]));
    else
        mcr_fill_lanes(at->n, same, whole);
    return whole;
}

/* The coat's part of f cos, and the base's without its colour. `out` and `in` are E of both directions. */
static void part_lanes(const struct coat *coat, const struct mcr_points *at, const double *const tangent[3], const double *alpha, const double *restrict x,
                       const double *restrict y, const double *restrict z, const double *out, const double *in, double *restrict specular,
                       double *restrict base)
{
    const double *nx = at->nx, *ny = at->ny, *nz = at->nz, *gx = at->gx, *gy = at->gy, *gz = at->gz, *ox = at->ox, *oy = at->oy, *oz = at->oz;
    const double *tx = tangent[0], *ty = tangent[1], *tz = tangent[2], index = coat->index, inverse = 1 / (index * index);
    const double rough = coat->smooth != 0 ? 0 : 1;

    for (uint32_t i = 0; i < at->n; i++) {
        struct mcr_frame f = mcr_frame(mcr_vector(nx[i], ny[i], nz[i]), mcr_vector(tx[i], ty[i], tz[i]));
        struct mcr_vector o = mcr_to_frame(f, mcr_vector(ox[i], oy[i], oz[i])), w = mcr_to_frame(f, mcr_vector(x[i], y[i], z[i]));
        struct mcr_ggx g = mcr_ggx_reflect(alpha[i], alpha[i], o, w);
        int seen = (o.z > MCR_GGX_HORIZON) & (w.z > MCR_GGX_HORIZON) & (gx[i] * x[i] + gy[i] * y[i] + gz[i] * z[i] > 0);
        double q, fresnel = rough * mcr_fresnel_dielectric(g.cosine, index, &q);

        specular[i] = seen ? g.value * fresnel : 0;
        base[i] = seen ? w.z * MCR_PER_PI * (1 - out[i]) * (1 - in[i]) * inverse : 0;
    }
}

static void colour_lanes(uint32_t n, const struct coat *coat, const double *whole, const double *specular, const double *base, const double *albedo,
                         uint32_t stride, double *restrict out)
{
    const double inverse = 1 / (coat->index * coat->index);

    for (uint32_t i = 0; i < n; i++) {
        double a = albedo[i * stride], k = 1 - (1 - whole[i]) * inverse;
        out[i] = specular[i] + base[i] * (a / (1 - a * k));
    }
}

static int32_t evaluate(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                        const struct mcr_points *at, const struct mcr_directions *toward, const struct mcr_colours *out)
{
    double *room = host->scratch(host, context), *channel[3] = {out->r, out->g, out->b};
    const uint64_t stride = mcr_padded(at->n);
    const double *tangent[3], *alpha = alpha_lanes(at, inputs, room + ALPHA * stride);
    const struct room r = room_of(at, inputs, alpha, room);
    const double *whole = whole_lanes(instance, at, &r, room + WHOLE * stride), *seen = out_lanes(instance, at, &r, room);

    mcr_tangent_lanes(at, room + TANGENT * stride, tangent);
    cosine_lanes(at, toward->x, toward->y, toward->z, room + COSINE * stride);
    albedo_lanes(instance, at->n, &r, room + COSINE * stride, room + IN * stride);
    part_lanes(instance, at, tangent, alpha, toward->x, toward->y, toward->z, seen, room + IN * stride, room + SPECULAR * stride, room + BASE * stride);
    for (uint32_t c = 0; c < 3; c++)
        colour_lanes(at->n, instance, whole, room + SPECULAR * stride, room + BASE * stride, inputs->channel[c], inputs->stride[c], channel[c]);
    return MCR_OK;
}

/* For the base, what colour_lanes expects integrated over all directions: (1 - E(o)) (1 - <E>) / n^2. */
static void integral_lanes(uint32_t n, const struct coat *coat, const double *e, const double *whole, double *restrict base)
{
    const double inverse = 1 / (coat->index * coat->index);

    for (uint32_t i = 0; i < n; i++)
        base[i] = (1 - e[i]) * (1 - whole[i]) * inverse;
}

/* To the errors of E's polynomials. */
static int32_t albedo(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                      const struct mcr_points *at, const struct mcr_colours *out)
{
    double *room = host->scratch(host, context), *channel[3] = {out->r, out->g, out->b};
    const uint64_t stride = mcr_padded(at->n);
    const struct room r = room_of(at, inputs, alpha_lanes(at, inputs, room + ALPHA * stride), room);
    const double *whole = whole_lanes(instance, at, &r, room + WHOLE * stride), *e = out_lanes(instance, at, &r, room);

    integral_lanes(at->n, instance, e, whole, room + BASE * stride);
    for (uint32_t c = 0; c < 3; c++)
        colour_lanes(at->n, instance, whole, e, room + BASE * stride, inputs->channel[c], inputs->stride[c], channel[c]);
    return MCR_OK;
}

/* The chance of the coat's lobe: its share of what is scattered, about, seen in grey. */
static void share_lanes(uint32_t n, const double *e, const double *red, const double *green, const double *blue, double *restrict share)
{
    for (uint32_t i = 0; i < n; i++) {
        double grey = (red[i] + green[i] + blue[i]) * (1.0 / 3), sum = e[i] + (1 - e[i]) * grey;
        share[i] = sum > 0 ? e[i] / sum : 0;
    }
}

static const double *shares(const struct coat *coat, const struct mcr_points *at, const struct mcr_inputs *inputs, const double *alpha, double *room)
{
    const uint64_t stride = mcr_padded(at->n);
    const struct room r = room_of(at, inputs, alpha, room);

    share_lanes(at->n, out_lanes(coat, at, &r, room), mcr_input_lanes(inputs, 0, at->n, room + RED * stride),
                mcr_input_lanes(inputs, 1, at->n, room + GREEN * stride), mcr_input_lanes(inputs, 2, at->n, room + BLUE * stride), room + SHARE * stride);
    return room + SHARE * stride;
}

static void density_lanes(const struct mcr_points *at, const double *const tangent[3], const double *alpha, const double *share, const double *restrict x,
                          const double *restrict y, const double *restrict z, double *restrict density)
{
    const double *nx = at->nx, *ny = at->ny, *nz = at->nz, *ox = at->ox, *oy = at->oy, *oz = at->oz;
    const double *tx = tangent[0], *ty = tangent[1], *tz = tangent[2];

    for (uint32_t i = 0; i < at->n; i++) {
        struct mcr_frame f = mcr_frame(mcr_vector(nx[i], ny[i], nz[i]), mcr_vector(tx[i], ty[i], tz[i]));
        struct mcr_vector o = mcr_to_frame(f, mcr_vector(ox[i], oy[i], oz[i])), w = mcr_to_frame(f, mcr_vector(x[i], y[i], z[i]));
        struct mcr_ggx g = mcr_ggx_reflect(alpha[i], alpha[i], o, w);
        int above = (o.z > MCR_GGX_HORIZON) & (w.z > MCR_GGX_HORIZON);
        double value = share[i] * g.density + (1 - share[i]) * (w.z * MCR_PER_PI);

        density[i] = above ? value : 0;
    }
}

static void draw_lanes(const struct mcr_points *at, const double *const tangent[3], const double *alpha, const double *share, const double *const *number,
                       double *restrict x, double *restrict y, double *restrict z)
{
    const double *nx = at->nx, *ny = at->ny, *nz = at->nz, *ox = at->ox, *oy = at->oy, *oz = at->oz, *u = number[0], *v = number[1], *choice = number[2];
    const double *tx = tangent[0], *ty = tangent[1], *tz = tangent[2];

    for (uint32_t i = 0; i < at->n; i++) {
        struct mcr_frame f = mcr_frame(mcr_vector(nx[i], ny[i], nz[i]), mcr_vector(tx[i], ty[i], tz[i]));
        struct mcr_vector o = mcr_to_frame(f, mcr_vector(ox[i], oy[i], oz[i])), m, l, w;
        int visible = o.z > MCR_GGX_HORIZON, diffuse = choice[i] >= share[i];
        double px, py, rest = mcr_disk_from_square(u[i], v[i], &px, &py);

        o.z = visible ? o.z : 1;
        m = mcr_ggx_visible(alpha[i], alpha[i], o, u[i], v[i]);
        l = mcr_mirrored(o, m, mcr_dot(m, m));
        l.x = diffuse ? px : l.x;
        l.y = diffuse ? py : l.y;
        l.z = diffuse ? sqrt(rest) : l.z;
        w = mcr_from_frame(f, l);
        int above = visible & (mcr_dot(f.n, w) > MCR_GGX_HORIZON);
        x[i] = above ? w.x : 0;
        y[i] = above ? w.y : 0;
        z[i] = above ? w.z : 0;
    }
}

/* Under a smooth coat the base alone is drawn. */
static const double *drawn_shares(const struct coat *coat, const struct mcr_points *at, const struct mcr_inputs *inputs, const double *alpha, double *room)
{
    if (coat->smooth == 0)
        return shares(coat, at, inputs, alpha, room);
    mcr_fill_lanes(at->n, 0, room + SHARE * mcr_padded(at->n));
    return room + SHARE * mcr_padded(at->n);
}

static int32_t density(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                       const struct mcr_points *at, const struct mcr_directions *toward, double *density)
{
    double *room = host->scratch(host, context);
    const double *tangent[3], *alpha = alpha_lanes(at, inputs, room + ALPHA * mcr_padded(at->n));
    const double *share = drawn_shares(instance, at, inputs, alpha, room);

    mcr_tangent_lanes(at, room + TANGENT * mcr_padded(at->n), tangent);
    density_lanes(at, tangent, alpha, share, toward->x, toward->y, toward->z, density);
    return MCR_OK;
}

static int32_t draw(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                    const struct mcr_points *at, const double *const *number, const struct mcr_directions *out, double *density)
{
    double *room = host->scratch(host, context);
    const double *tangent[3], *alpha = alpha_lanes(at, inputs, room + ALPHA * mcr_padded(at->n));
    const double *share = drawn_shares(instance, at, inputs, alpha, room);

    mcr_tangent_lanes(at, room + TANGENT * mcr_padded(at->n), tangent);
    draw_lanes(at, tangent, alpha, share, number, out->x, out->y, out->z);
    if (density)
        density_lanes(at, tangent, alpha, share, out->x, out->y, out->z, density);
    return MCR_OK;
}

/* ---- a smooth coat's lobe ---- */

static void mirror_lanes(const struct mcr_points *at, double index, const double *share, const double *choice, double *restrict x, double *restrict y,
                         double *restrict z, double *restrict probability, double *restrict weight)
{
    const double *nx = at->nx, *ny = at->ny, *nz = at->nz, *gx = at->gx, *gy = at->gy, *gz = at->gz, *ox = at->ox, *oy = at->oy, *oz = at->oz;

    for (uint32_t i = 0; i < at->n; i++) {
        struct mcr_vector n = mcr_vector(nx[i], ny[i], nz[i]), o = mcr_vector(ox[i], oy[i], oz[i]), w = mcr_mirrored(o, n, mcr_dot(n, n));
        double c = mcr_dot(n, o), fix = 0.5 * (1 - mcr_dot(w, w)), reflected = smooth_albedo(index, c);
        int above = (c > 0) & (gx[i] * w.x + gy[i] * w.y + gz[i] * w.z > 0), chosen = above & (choice[i] < share[i]);

        x[i] = chosen ? w.x + w.x * fix : 0;
        y[i] = chosen ? w.y + w.y * fix : 0;
        z[i] = chosen ? w.z + w.z * fix : 0;
        probability[i] = above ? (chosen ? share[i] : 1 - share[i]) : 1;
        weight[i] = chosen ? reflected : 0;
    }
}

static int32_t delta(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                     const struct mcr_points *at, const double *const *number, const struct mcr_directions *out, double *probability,
                     const struct mcr_colours *weight)
{
    const struct coat *coat = instance;
    double *room = host->scratch(host, context), *channel[3] = {weight->r, weight->g, weight->b};
    const double *share;

    if (coat->smooth != 0)
        share = shares(coat, at, inputs, alpha_lanes(at, inputs, room + ALPHA * mcr_padded(at->n)), room);
    else
        mcr_fill_lanes(at->n, 0, room), share = room;
    for (uint32_t c = 0; c < 3; c++)
        mirror_lanes(at, coat->index, share, number[0], out->x, out->y, out->z, probability, channel[c]);
    return MCR_OK;
}

MCR_HIDDEN const struct mcr_material_plugin MCR_ISA_NAME(descriptor) = {
    .head = {.size = sizeof(struct mcr_material_plugin),
             .kind = MCR_KIND_MATERIAL,
             .isa = MCR_ISA,
             .parameter_count = PARAMETERS,
             .name = "glossy",
             .version = "0.9",
             .licence = "Apache-2.0",
             .summary = "diffuse under a clear coat, smooth or rough, two-sided; loses no light",
             .parameters = parameters},
    .create = create,
    .destroy = destroy,
    .traits = traits,
    .scratch_bytes = scratch_bytes,
    .evaluate = evaluate,
    .draw = draw,
    .density = density,
    .delta = delta,
    .albedo = albedo,
};

MCR_PLUGIN(struct mcr_material_plugin, descriptor);
