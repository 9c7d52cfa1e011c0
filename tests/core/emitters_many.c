/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Many emitters, which are chosen through a tree: every one that sees a point has a chance there; chances of those that see it sum to the
 * mass; they are drawn as often as is told; chances are worth having (few draws are lost, and their weights are even); and trees of odd
 * sets, equal positions, powers from 1e-30 to 1e30, sizes from 1e-12 to 10, whole sets of 1e-40 or 1e40, a million of their sizes off the
 * origin, are as good; points are up to 1e15 away.
 */
#define MOST_SHAPES 2600
#define MOST_TRIANGLES 500
#include "core/emitter_lanes.h"
#include "emitters_scene.h"

#define LANES 4096u
#define ROUNDS 64u
#ifndef SALT
#define SALT 0
#endif

static double number(uint64_t key, uint64_t which)
{
    return mcr_number(mcr_mix64(key), which);
}

static void unit(uint64_t key, uint64_t which, double out[3])
{
    double z = 2 * number(key, which) - 1, angle = 2 * MCR_PI * number(key, which + 1), rho = sqrt(1 - z * z);
    out[0] = rho * cos(angle);
    out[1] = rho * sin(angle);
    out[2] = z;
}

/* One emitter of any kind and sides, of about `size`, around c. */
static void add_any(struct stage *s, uint64_t key, const double c[3], double size, double radiance)
{
    static const uint32_t sides[] = {FRONT, BACK, FRONT | BACK};
    double a[3], b[3], d[3], axes[3][3];
    uint32_t side = sides[(uint32_t)(3 * number(key, 50))];
    unit(key, 60, a);
    unit(key, 62, b);
    unit(key, 64, d);
    for (int i = 0; i < 3; i++) {
        a[i] *= size, b[i] *= size, d[i] *= size;
        axes[0][i] = a[i], axes[1][i] = b[i], axes[2][i] = d[i];
    }
    switch ((uint32_t)(5 * number(key, 51))) {
    case 0:
        stage_flat(s, MCR_SHAPE_PARALLELOGRAM, side, radiance, c, a, b);
        break;
    case 1:
        stage_flat(s, MCR_SHAPE_DISK, side, radiance, c, a, b);
        break;
    case 2:
        stage_sphere(s, side, radiance, c, size);
        break;
    case 3:
        stage_axes(s, MCR_SHAPE_ELLIPSOID, side, radiance, c, axes);
        break;
    default:
        stage_axes(s, MCR_SHAPE_BOX, side, radiance, c, axes);
    }
}

enum set { CLOUD, CLUSTERS, CEILING, LINE, ONE_PLACE, POWERS, SIZES, SMALL, LARGE, ASIDE, SETS };
static const char *const set_name[SETS] = {"cloud", "clusters", "ceiling", "line", "one place", "powers of 1e-30 to 1e30",
                                           "sizes of 1e-12 to 10", "all 1e-40 wide", "all 1e40 wide", "a million off"};

/* Times the cube below, and where its middle is on each axis. */
static double unit_of(enum set set)
{
    return set == SMALL ? 1e-40 : set == LARGE ? 1e40 : 1;
}

static double middle_of(enum set set)
{
    return set == ASIDE ? 1e6 : 0;
}

/* n emitters in and around the cube [-1, 1]^3; boxes count as six. */
static void make(struct stage *s, enum set set, uint32_t n)
{
    stage_begin(s);
    for (uint32_t i = 0; i < n; i++) {
        double c[3], size = 0.2 / cbrt(n), radiance = 1 + 3 * number(i, 1);
        for (int k = 0; k < 3; k++)
            c[k] = 2 * number(i, 2 + (uint64_t)k) - 1;
        switch (set) {
        case CLUSTERS:
            for (int k = 0; k < 3; k++)
                c[k] = 0.03 * c[k] + 1.6 * number(i % 7, 5 + (uint64_t)k) - 0.8;
            size *= 0.1;
            break;
        case CEILING: /* faces down; some hang from it */
            if (i % 8) {
                uint32_t side = (uint32_t)ceil(sqrt(n));
                double corner[3] = {2.0 * (i / side) / side - 1, 2.0 * (i % side) / side - 1, 1}, e0[3] = {0, 1.8 / side, 0},
                       e1[3] = {1.8 / side, 0, 0};
                stage_flat(s, MCR_SHAPE_PARALLELOGRAM, FRONT, radiance, corner, e0, e1);
                continue;
            }
            break;
        case LINE:
            c[1] = 0.25, c[2] = -0.5;
            break;
        case ONE_PLACE:
            c[0] = c[1] = c[2] = 0.125;
            size = 0.1;
            break;
        case POWERS:
            radiance = pow(10, 60 * number(i, 9) - 30);
            break;
        case SIZES:
            size = pow(10, 13 * number(i, 9) - 12);
            break;
        default:
            break;
        }
        for (int k = 0; k < 3; k++)
            c[k] = middle_of(set) + unit_of(set) * c[k];
        add_any(s, i, c, unit_of(set) * size, radiance);
    }
    for (uint32_t t = 0; t < MOST_TRIANGLES && t < n / 6; t++) {
        double p[3][3];
        for (int v = 0; v < 3; v++)
            for (int k = 0; k < 3; k++)
                p[v][k] = middle_of(set) +
                          unit_of(set) * (2 * number(t, 20 + (uint64_t)k) - 1 + 0.1 * number(t, 30 + 3 * (uint64_t)v + (uint64_t)k));
        stage_triangle(s, t % 2 ? FRONT : BACK, 1, p[0], p[1], p[2]);
    }
    stage_ready(s);
}

static double length_of(const double *v)
{
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

/* Far from its plane or surface by more than roundings: 1 seen, -1 not seen, 0 too close to say. Knows shapes by their constants. */
static int sees(const struct mcr_emitters *all, enum set set, uint32_t e, const double p[3])
{
    const struct mcr_emitter *emitter = &all->emitter[e];
    const double *k = all->k[e];
    double d[3] = {p[0] - k[0], p[1] - k[1], p[2] - k[2]}, height;
    if (emitter->kind == MCR_EMITTER_SPHERE) {
        height = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) - k[MCR_K_RADIUS];
    } else if (emitter->kind == MCR_EMITTER_ELLIPSOID) {
        const double *m = k + MCR_K_DUAL0;
        double square = 0;
        for (int i = 0; i < 3; i++) {
            double x = m[3 * i] * d[0] + m[3 * i + 1] * d[1] + m[3 * i + 2] * d[2];
            square += x * x;
        }
        height = (sqrt(square) - 1) * fmin(length_of(k + MCR_K_E0), fmin(length_of(k + MCR_K_E1), length_of(k + MCR_K_N)));
    } else {
        const double *n = k + MCR_K_N;
        height = (d[0] * n[0] + d[1] * n[1] + d[2] * n[2]) / sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    }
    return fabs(height) < 1e-12 * (unit_of(set) + middle_of(set)) ? 0 : (height > 0 ? emitter->sides & FRONT : emitter->sides & BACK) ? 1 : -1;
}

/* A point of emitter e that is seen from p: of the upper half of a sphere or ellipsoid if p is outside. */
static void point_of(const struct mcr_emitters *all, uint32_t e, const double p[3], double q[3])
{
    const double *k = all->k[e];
    double d[3] = {p[0] - k[0], p[1] - k[1], p[2] - k[2]}, length;
    uint32_t kind = all->emitter[e].kind;
    if (kind == MCR_EMITTER_SPHERE) {
        length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
        for (int i = 0; i < 3; i++)
            q[i] = k[i] + d[i] / length * k[MCR_K_RADIUS];
    } else if (kind == MCR_EMITTER_ELLIPSOID) {
        const double *m = k + MCR_K_DUAL0;
        double x[3], square = 0;
        for (int i = 0; i < 3; i++) {
            x[i] = m[3 * i] * d[0] + m[3 * i + 1] * d[1] + m[3 * i + 2] * d[2];
            square += x[i] * x[i];
        }
        for (int i = 0; i < 3; i++)
            q[i] = k[i] + (k[MCR_K_E0 + i] * x[0] + k[MCR_K_E1 + i] * x[1] + k[MCR_K_N + i] * x[2]) / sqrt(square);
    } else {
        double share = kind == MCR_EMITTER_DISK ? 0 : 0.3;
        for (int i = 0; i < 3; i++)
            q[i] = k[i] + share * (k[MCR_K_E0 + i] + k[MCR_K_E1 + i]);
    }
}

/* The chances of all emitters at one point, told by density_point: its quotient with the density that the same emitter has alone. */
struct chances {
    uint32_t n, padded;
    int32_t *emitter;
    double *q[7], *density, *chance;
    struct batch b;
};

static void chances_begin(struct chances *c, uint32_t n)
{
    memset(c, 0, sizeof *c);
    c->n = n;
    c->emitter = calloc(n + 16, sizeof *c->emitter);
    for (int i = 0; i < 7; i++)
        c->q[i] = doubles(n);
    c->density = doubles(n);
    c->chance = doubles(n);
    batch_begin(&c->b, n);
    batch_normals(&c->b);
}

static void chances_end(struct chances *c)
{
    for (int i = 0; i < 7; i++)
        free(c->q[i]);
    free(c->emitter);
    free(c->density);
    free(c->chance);
    batch_end(&c->b);
}

/* density = chance * r^2 / (area cos), or for an ellipsoid what its own measure says. */
static double alone(const struct mcr_emitters *all, uint32_t e, const double q[3], const double w[3], double distance)
{
    const double *k = all->k[e];
    uint32_t kind = all->emitter[e].kind;
    double cosine = 0, area = all->emitter[e].area;
    if (kind == MCR_EMITTER_ELLIPSOID) {
        const double *m = k + MCR_K_DUAL0;
        for (int i = 0; i < 3; i++)
            cosine += (m[3 * i] * w[0] + m[3 * i + 1] * w[1] + m[3 * i + 2] * w[2]) *
                      (m[3 * i] * (q[0] - k[0]) + m[3 * i + 1] * (q[1] - k[1]) + m[3 * i + 2] * (q[2] - k[2]));
        return k[MCR_K_SPREAD] * distance * distance / fabs(cosine);
    }
    if (kind == MCR_EMITTER_SPHERE) {
        for (int i = 0; i < 3; i++)
            cosine += (q[i] - k[i]) * w[i] / k[MCR_K_RADIUS];
    } else {
        const double *n = k + MCR_K_N;
        cosine = (n[0] * w[0] + n[1] * w[1] + n[2] * w[2]) / sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    }
    return distance * distance / (area * fabs(cosine));
}

static void find_chances(struct chances *c, const struct stage *s, const double p[3], const double n[3])
{
    const struct mcr_emitters *all = s->emitters;
    struct mcr_emitter_points points = {sizeof points, c->n, c->emitter, c->q[0], c->q[1], c->q[2], c->q[3], c->q[4], c->q[5], c->q[6]};
    batch_at(&c->b, p);
    for (uint32_t e = 0; e < c->n; e++) {
        double q[3], d[3], square = 0;
        point_of(all, e, p, q);
        for (int i = 0; i < 3; i++) {
            d[i] = q[i] - p[i];
            square += d[i] * d[i];
        }
        c->emitter[e] = (int32_t)e;
        c->q[6][e] = sqrt(square);
        for (int i = 0; i < 3; i++) {
            c->q[i][e] = q[i];
            c->q[3 + i][e] = d[i] / c->q[6][e];
        }
        c->b.nx[e] = n[0], c->b.ny[e] = n[1], c->b.nz[e] = n[2];
    }
    best_functions()->density_point(all, s->scratch, MCR_LIGHT_BY_AREA, &c->b.at, &points, c->density);
    for (uint32_t e = 0; e < c->n; e++) {
        double q[3] = {c->q[0][e], c->q[1][e], c->q[2][e]}, w[3] = {c->q[3][e], c->q[4][e], c->q[5][e]};
        c->chance[e] = c->density[e] > 0 ? c->density[e] / alone(all, e, q, w, c->q[6][e]) : 0;
    }
}

/* A point in the cube, near a surface, in a plane, or `far` away; and a normal, or none. */
static void some_point(const struct stage *s, enum set set, uint64_t key, double far, double p[3], double n[3])
{
    const double *k = s->emitters->k[(uint32_t)(s->emitters->count * number(key, 99))];
    const double unit_length = unit_of(set);
    double reach = unit_length * (key % 7 == 6 ? far : 1), along[3];
    unit(key, 104, along);
    for (int i = 0; i < 3; i++) {
        p[i] = middle_of(set) + reach * (2.4 * number(key, 100 + (uint64_t)i) - 1.2);
        if (key % 7 == 1) /* close to an emitter */
            p[i] = k[i] + unit_length * 1e-3 * along[i];
        else if (key % 7 == 2) /* over its plane by very little, beside it and far beside it */
            p[i] = k[i] + 0.37 * k[MCR_K_E0 + i] + 0.012 * far * k[MCR_K_E1 + i] + unit_length * 1e-9 * (far / 1e3) * along[i];
        else if (key % 7 == 3)
            p[i] = k[i] + unit_length * 1e-7 * along[i];
    }
    unit(key, 106, n);
    if (key % 4 == 0)
        n[0] = n[1] = n[2] = 0;
}

static void test_chances(enum set set, uint32_t n)
{
    static struct stage s;
    struct chances c;
    double worst = 0, smallest = 1;
    uint64_t lost = 0, blind = 0, seen = 0;
    make(&s, set, n);
    chances_begin(&c, s.emitters->count);
    for (uint64_t key = 0; key < 140; key++) {
        double p[3], normal[3], sum = 0, mass;
        int close = 0;
        some_point(&s, set, key, 1e3, p, normal);
        find_chances(&c, &s, p, normal);
        for (uint32_t e = 0; e < c.n; e++) {
            int here = sees(s.emitters, set, e, p);
            close |= here == 0;
            seen += here > 0;
            lost += here > 0 && !(c.chance[e] > 0);
            blind += here < 0 && c.chance[e] > 0;
            smallest = here > 0 ? fmin(smallest, c.chance[e]) : smallest;
            sum += c.chance[e];
        }
        struct mcr_points first = c.b.at; /* one lane */
        first.n = 1;
        best_functions()->mass(s.emitters, s.scratch, 1, &first, &mass);
        worst = close ? worst : fmax(worst, fabs(sum - mass));
    }
    ok(lost == 0 && seen > 1000, "%s, %u emitters: each that sees a point has a chance (%llu of %llu have none; the least has %.1e)",
       set_name[set], c.n, (unsigned long long)lost, (unsigned long long)seen, smallest);
    ok(blind == 0, "%s, %u emitters: no density from those that do not see it (%llu)", set_name[set], c.n, (unsigned long long)blind);
    ok(worst < 1e-6, "%s, %u emitters: the chances sum to the mass, to %.1e", set_name[set], c.n, worst);
    chances_end(&c);
    stage_end(&s);
}

/* Of 16 lanes at a point: how many tell another probability of what they chose, if anything, than is told of it, to the bit. */
static uint32_t told_otherwise(const struct stage *s, uint64_t key, const double p[3], const double n[3])
{
    struct mcr_emitter_scratch *scratch = s->scratch;
    double at[6][16], numbers[16], share[16];
    int64_t chosen[16];
    uint32_t wrong = 0;
    for (uint32_t i = 0; i < 16; i++) {
        for (int k = 0; k < 6; k++)
            at[k][i] = k < 3 ? p[k] : n[k - 3];
        numbers[i] = number(key, 200 + i);
    }
    struct mcr_emitter_lanes points = {.n = 16, .px = at[0], .py = at[1], .pz = at[2], .nx = at[3], .ny = at[4], .nz = at[5]};
    MCR_ISA_NAME(mcr_emitter_choose)(s->emitters, &points, numbers, scratch);
    memcpy(share, scratch->share, sizeof share);
    memcpy(chosen, scratch->chosen, sizeof chosen);
    for (uint32_t i = 0; i < 16; i++)
        wrong += chosen[i] >= 0 && share[i] != MCR_ISA_NAME(mcr_emitter_chance)(s->emitters, &points, i, (uint32_t)chosen[i], &scratch->descent);
    return wrong;
}

/*
 * The same from the tree itself, at places where densities have lost their digits or are out of range: scenes of other sizes, and points
 * that are very far away.
 */
static void test_extremes(enum set set, uint32_t n)
{
    static struct stage s;
    uint64_t lost = 0, seen = 0;
    double worst = 0, smallest = 1;
    uint32_t wrong = 0;
    make(&s, set, n);
    struct mcr_emitter_descent *scratch = &((struct mcr_emitter_scratch *)s.scratch)->descent;
    for (uint64_t key = 0; key < 140; key++) {
        double p[3], normal[3], sum = 0, mass;
        int close = 0;
        some_point(&s, set, key, pow(10, 3 * (double)(key % 5) + 3), p, normal);
        struct mcr_emitter_lanes point = {.n = 1, .px = p, .py = p + 1, .pz = p + 2, .nx = normal, .ny = normal + 1, .nz = normal + 2};
        for (uint32_t e = 0; e < s.emitters->count; e++) {
            double chance = MCR_ISA_NAME(mcr_emitter_chance)(s.emitters, &point, 0, e, scratch);
            int here = sees(s.emitters, set, e, p);
            close |= here == 0;
            seen += here > 0;
            lost += here > 0 && !(chance > 0);
            smallest = here > 0 ? fmin(smallest, chance) : smallest;
            sum += here > 0 ? chance : 0;
        }
        wrong += told_otherwise(&s, key, p, normal);
        MCR_ISA_NAME(mcr_emitter_tree_mass)(s.emitters, &point, &mass, scratch);
        worst = close ? worst : fmax(worst, fabs(sum - mass));
    }
    ok(lost == 0 && seen > 1000, "%s, %u emitters: each that sees a point has a chance (%llu of %llu have none; the least has %.1e)",
       set_name[set], s.emitters->count, (unsigned long long)lost, (unsigned long long)seen, smallest);
    ok(worst < 1e-9, "%s, %u emitters: the chances sum to the mass, to %.1e", set_name[set], s.emitters->count, worst);
    ok(wrong == 0, "%s, %u emitters: what is drawn has the very probability that is told of it (%u have not)", set_name[set],
       s.emitters->count, wrong);
    stage_end(&s);
}

/* Chi-square of a quarter of a million choices against the chances told, as a normal deviate (Wilson and Hilferty 1931); cells below 10 are pooled. */
static void test_choices(enum set set, uint32_t n, uint64_t key)
{
    static struct stage s;
    struct chances c;
    struct batch b;
    double p[3], normal[3], *q[8], chi = 0, degrees = 0, total = 0, expected_rest = 0, rest = 0, worst = 0;
    int32_t *emitter = calloc(LANES + 16, sizeof *emitter);
    make(&s, set, n);
    uint32_t *count = calloc(s.emitters->count, sizeof *count), none = 0;
    some_point(&s, set, key, 1e3, p, normal);
    chances_begin(&c, s.emitters->count);
    find_chances(&c, &s, p, normal);
    batch_begin(&b, LANES);
    batch_normals(&b);
    batch_at(&b, p);
    for (int i = 0; i < 8; i++)
        q[i] = doubles(LANES);
    for (uint32_t i = 0; i < LANES; i++)
        b.nx[i] = normal[0], b.ny[i] = normal[1], b.nz[i] = normal[2];
    struct mcr_emitter_points points = {sizeof points, LANES, emitter, q[0], q[1], q[2], q[3], q[4], q[5], q[6]};
    for (uint32_t round = 0; round < ROUNDS; round++) {
        batch_numbers(&b, 70000 + SALT + 1000 * key + round);
        best_functions()->draw_point(s.emitters, s.scratch, round % 2, &b.at, (const double *const *)b.u, &points, q[7]);
        best_functions()->density_point(s.emitters, s.scratch, round % 2, &b.at, &points, b.density);
        for (uint32_t i = 0; i < LANES; i++) {
            if (emitter[i] < 0) {
                none++;
                continue;
            }
            count[emitter[i]]++;
            worst = fmax(worst, fabs(b.density[i] / q[7][i] - 1));
        }
        total += LANES;
    }
    double mass = 0;
    for (uint32_t e = 0; e < c.n; e++) {
        double expected = c.chance[e] * total;
        mass += c.chance[e];
        if (expected < 10) {
            expected_rest += expected;
            rest += count[e];
            continue;
        }
        chi += (count[e] - expected) * (count[e] - expected) / expected;
        degrees++;
    }
    chi += expected_rest > 1 ? (rest - expected_rest) * (rest - expected_rest) / expected_rest : 0;
    degrees += expected_rest > 1 ? 1 : 0;
    double lost = (1 - mass) * total;
    chi += lost > 10 ? (none - lost) * (none - lost) / lost : 0;
    degrees += lost > 10 ? 1 : 0;
    double scale = 2 / (9 * fmax(degrees - 1, 1)), z = (cbrt(chi / fmax(degrees - 1, 1)) - (1 - scale)) / sqrt(scale);
    ok(degrees > 2 ? fabs(z) <= 4 : count[0] <= total, "%s, %u emitters, point %u: chosen as often as told, z = %.2f (%g cells, %.1f %% empty)",
       set_name[set], c.n, (unsigned)key, z, degrees, 100 * none / total);
    ok(worst < 1e-6, "%s, %u emitters, point %u: draws tell their densities, to %.1e", set_name[set], c.n, (unsigned)key, worst);
    for (int i = 0; i < 8; i++)
        free(q[i]);
    free(emitter);
    free(count);
    chances_end(&c);
    batch_end(&b);
    stage_end(&s);
}

int main(void)
{
    for (int set = CLOUD; set < SETS; set++) {
        test_extremes(set, 17);
        test_extremes(set, 300);
    }
    for (int set = CLOUD; set < SIZES; set++) {
        test_chances(set, 17);
        test_chances(set, 300);
        test_choices(set, 300, 0);
        test_choices(set, 300, 1);
        test_choices(set, 300, 5);
    }
    test_chances(CLOUD, 2500);
    test_choices(CLOUD, 2500, 4);
    test_choices(CEILING, 2500, 5);
    return tap_done();
}
