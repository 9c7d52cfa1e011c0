/* SPDX-License-Identifier: Apache-2.0 */
/*
 * mix and mask: what they make of the materials inside them, against the same computed from those materials one by one. Inside are materials that are
 * made up, of which every answer is written down (inside.h), others of the program's, and further mixes and masks.
 */
#include "inside.h"

/* ---- The truth ---- */

static double setting(const struct matter *m, uint32_t c, uint32_t i) { return m->own[c][i * m->stride[c]]; }
static double amount_at(const struct matter *m, uint32_t i) { return setting(m, 6, i); }
static double opacity_at(const struct matter *m, int c, uint32_t i) { return setting(m, 3 + c, i); }

/* What a tree is asked for; colours, of which a density is one channel. */
enum question { EVALUATE, DENSITY, EMISSION, PASSES, ALBEDO };
static const uint32_t does_it[] = {SCATTERS, SCATTERS, EMITS, MCR_MATERIAL_PASSES, SCATTERS | MCR_MATERIAL_DELTA};

static int32_t ask(const struct matter *m, enum question question, const struct mcr_points *at, const struct mcr_directions *toward,
                   const struct mcr_colours *out)
{
    const struct mcr_material_plugin *p = m->plugin;
    void *before = begin(&context, m, at);
    int32_t status = question == EVALUATE  ? p->evaluate(&host, &context, m->instance, &m->inputs, at, toward, out)
                     : question == DENSITY ? p->density(&host, &context, m->instance, &m->inputs, at, toward, out->r)
                     : question == EMISSION ? p->emission(&host, &context, m->instance, &m->inputs, at, out)
                     : question == PASSES  ? p->passes(&host, &context, m->instance, &m->inputs, at, out)
                                           : p->albedo(&host, &context, m->instance, &m->inputs, at, out);
    return end(&context, before, status);
}

static struct mcr_colours colours_array(uint32_t n)
{
    return (struct mcr_colours){sizeof(struct mcr_colours), n, array(n), array(n), array(n)};
}

static void free_colours(struct mcr_colours *c) { free(c->r), free(c->g), free(c->b); }

/* Leaves are asked themselves; mixes and masks are what the manual says of them. */
static void truth(const struct matter *m, enum question question, const struct mcr_points *at, const struct mcr_directions *toward,
                  const struct mcr_colours *out)
{
    double *channel[3] = {out->r, out->g, out->b};
    struct mcr_colours other;

    if (m->kind == LEAF) {
        for (int c = 0; c < 3; c++)
            memset(channel[c], 0, at->n * sizeof(double));
        if (m->traits.does & does_it[question])
            ask(m, question, at, toward, out);
        return;
    }
    truth(m->inner[0], question, at, toward, out);
    if (m->kind == MASK) {
        for (int c = 0; c < 3 && question != DENSITY; c++)
            for (uint32_t i = 0; i < at->n; i++) {
                double o = opacity_at(m, c, i);
                channel[c][i] = question == PASSES ? 1 - o + o * channel[c][i] : o * channel[c][i];
            }
        return;
    }
    other = colours_array(at->n);
    truth(m->inner[1], question, at, toward, &other);
    const double *with[3] = {other.r, other.g, other.b};
    int one = (m->inner[0]->traits.does & SCATTERS) != 0, two = (m->inner[1]->traits.does & SCATTERS) != 0;
    for (int c = 0; c < 3; c++)
        for (uint32_t i = 0; i < at->n; i++) {
            double t = amount_at(m, i);
            t = question == DENSITY && !one ? 1 : question == DENSITY && !two ? 0 : t; /* only what scatters draws */
            channel[c][i] = channel[c][i] + t * (with[c][i] - channel[c][i]);
        }
    free_colours(&other);
}

/*
 * All that is answered by one number or colour, over random directions. Every level of a tree adds 3 roundings to numbers that are at most `most`,
 * and the truth as many: 8 levels, 2 * 3 * 8 * 2^-53 * most.
 */
static void test_answers(const struct matter *m, const char *what)
{
    static const char *const word[] = {"evaluate", "density", "emission", "passes", "albedo"};
    struct mcr_points at = points_array(LANES);
    struct mcr_directions toward = directions_array(LANES);
    uint32_t wrong[5] = {0}, written = 0;

    for (uint32_t i = 0; i < LANES; i++) {
        double w[3];
        unit_vector(80, i, w);
        toward.x[i] = w[0], toward.y[i] = w[1], toward.z[i] = w[2];
    }
    memset(&asked, 0, sizeof asked);
    asked.points = at.px;
    for (enum question q = EVALUATE; q <= ALBEDO; q++) {
        struct mcr_colours out = colours_array(LANES), right = colours_array(LANES);
        const double *got[3] = {out.r, out.g, out.b}, *wanted[3] = {right.r, right.g, right.b};
        wrong[q] += ask(m, q, &at, &toward, &out) != MCR_OK;
        truth(m, q, &at, &toward, &right);
        for (int c = 0; c < (q == DENSITY ? 1 : 3); c++) {
            double most = 0;
            for (uint32_t i = 0; i < LANES; i++)
                most = fmax(most, wanted[c][i]);
            for (uint32_t i = 0; i < LANES; i++)
                wrong[q] += !(fabs(got[c][i] - wanted[c][i]) <= 24 * ULP * most);
            written += !guarded(got[c], LANES);
        }
        free_colours(&out);
        free_colours(&right);
        ok(wrong[q] == 0, "%u %s: %s (%u lanes wrong)", isa, what, word[q], wrong[q]);
    }
    ok(written == 0 && asked.elsewhere == 0 && asked.lacking == 0, "%u %s: children are asked at the points as they came, for what they have", isa, what);
    free_points(&at);
    free_directions(&toward);
}

/* `draw` and `density` agree to the bit; each recipe is asked for the lanes that chose it, in all as many as there are lanes. */
static void test_draw(const struct matter *m, const char *what, int recipes_only)
{
    struct mcr_points at = points_array(LANES);
    struct mcr_directions out = directions_array(LANES), again = directions_array(LANES);
    double *number[3] = {numbers(LANES, 90), numbers(LANES, 91), numbers(LANES, 92)}, *density = array(LANES), *same = array(LANES), *wanted = array(LANES);
    struct mcr_colours told = {sizeof told, LANES, same, NULL, NULL};
    uint32_t differ = 0, bad = 0;
    double some = 0;
    void *before;

    memset(&asked, 0, sizeof asked);
    asked.points = at.px;
    number[2][0] = 0, number[2][1] = 1 - 0x1p-53;
    before = begin(&context, m, &at);
    bad += end(&context, before, m->plugin->draw(&host, &context, m->instance, &m->inputs, &at, (const double *const *)number, &out, density)) != MCR_OK;
    some = asked.wanted;
    ask(m, DENSITY, &at, &out, &told);
    for (uint32_t i = 0; i < LANES; i++) {
        differ += density[i] != same[i];
        bad += !(density[i] >= 0) || isnan(out.x[i]) || (density[i] > 0) != (out.x[i] != 0 || out.y[i] != 0 || out.z[i] != 0);
    }
    ok(differ == 0 && bad == 0 && asked.numbers == 0, "%u %s: what is drawn has the density that is told, to the bit", isa, what);
    if (recipes_only)
        ok(some == LANES, "%u %s: each lane is wanted of one material (%.0f)", isa, what, some);
    for (uint32_t i = 0; i < LANES; i++)
        wanted[i] = i % 3 == 0;
    at.wanted = wanted;
    asked.wanted = 0;
    before = begin(&context, m, &at);
    end(&context, before, m->plugin->draw(&host, &context, m->instance, &m->inputs, &at, (const double *const *)number, &again, NULL));
    for (uint32_t i = 0; i < LANES; i += 3)
        differ += again.x[i] != out.x[i] || again.y[i] != out.y[i] || again.z[i] != out.z[i];
    ok(differ == 0 && (!recipes_only || asked.wanted == (LANES + 2) / 3), "%u %s: of lanes that nobody wants, nothing is wanted", isa, what);
    ok(guarded(out.x, LANES) && guarded(out.y, LANES) && guarded(out.z, LANES) && guarded(density, LANES), "%u %s: nothing behind the lanes", isa, what);
    at.wanted = NULL;
    free_points(&at);
    free_directions(&out);
    free_directions(&again);
    free(number[0]), free(number[1]), free(number[2]), free(density), free(same), free(wanted);
}

/*
 * Chi-square of MANY directions against the density, over 16 x 32 cells of height and azimuth of the sphere about one normal. A cell's expected count is
 * the density's integral by the midpoint rule on 16 x 16 points; what it integrates to in all is the share that is drawn. Wilson and Hilferty (1931)
 * make a normal deviate of chi-square.
 */
static void test_chi_square(const struct matter *m, const char *what)
{
    enum { ROWS = 16, COLUMNS = 32, FINE = 16 };
    struct mcr_points at = points_array(MANY);
    struct mcr_directions out = directions_array(MANY), toward = directions_array(MANY);
    double *number[3], *density = array(MANY), chi = 0, df = -1, z, total = 0, drawn = 0;
    double n[3] = {at.nx[9], at.ny[9], at.nz[9]}, o[3], t[3], b[3];
    struct mcr_colours told = {sizeof told, MANY, density, NULL, NULL};
    double *constant[9] = {(double *)at.nx, (double *)at.ny, (double *)at.nz, (double *)at.gx, (double *)at.gy, (double *)at.gz,
                           (double *)at.ox, (double *)at.oy, (double *)at.oz};
    static double count[ROWS][COLUMNS], expected[ROWS][COLUMNS];
    void *before;

    memset(count, 0, sizeof count);
    memset(expected, 0, sizeof expected);
    mcr_basis(n[0], n[1], n[2], &t[0], &t[1], &t[2], &b[0], &b[1], &b[2]);
    for (int c = 0; c < 3; c++) {
        o[c] = 0.6 * t[c] + 0.8 * n[c];
        number[c] = numbers(MANY, 120 + c);
        for (uint32_t i = 0; i < MANY; i++)
            constant[c][i] = constant[3 + c][i] = n[c], constant[6 + c][i] = o[c];
    }
    asked.points = at.px;
    before = begin(&context, m, &at);
    end(&context, before, m->plugin->draw(&host, &context, m->instance, &m->inputs, &at, (const double *const *)number, &out, NULL));
    for (uint32_t i = 0; i < MANY; i++) {
        double h = n[0] * out.x[i] + n[1] * out.y[i] + n[2] * out.z[i];
        double azimuth = atan2(out.x[i] * b[0] + out.y[i] * b[1] + out.z[i] * b[2], out.x[i] * t[0] + out.y[i] * t[1] + out.z[i] * t[2]);
        int row = (int)((h + 1) / 2 * ROWS), column = (int)((azimuth / (2 * M_PI) + 0.5) * COLUMNS);

        if (out.x[i] == 0 && out.y[i] == 0 && out.z[i] == 0)
            continue;
        drawn++;
        count[row < ROWS ? row : ROWS - 1][column < COLUMNS ? column : COLUMNS - 1]++;
    }
    for (uint32_t i = 0; i < MANY; i++) {
        uint32_t row = i / (COLUMNS * FINE), column = i % (COLUMNS * FINE);
        double h = 2 * (row + 0.5) / (ROWS * FINE) - 1, s = sqrt(1 - h * h), phi = 2 * M_PI * ((column + 0.5) / (COLUMNS * FINE) - 0.5);

        toward.x[i] = s * cos(phi) * t[0] + s * sin(phi) * b[0] + h * n[0];
        toward.y[i] = s * cos(phi) * t[1] + s * sin(phi) * b[1] + h * n[1];
        toward.z[i] = s * cos(phi) * t[2] + s * sin(phi) * b[2] + h * n[2];
    }
    ask(m, DENSITY, &at, &toward, &told);
    for (uint32_t i = 0; i < MANY; i++) /* each point is 4 pi / MANY of the sphere, and MANY were drawn */
        expected[i / (COLUMNS * FINE) / FINE][i % (COLUMNS * FINE) / FINE] += density[i] * 4 * M_PI;
    for (int r = 0; r < ROWS; r++)
        for (int c = 0; c < COLUMNS; c++) {
            df += expected[r][c] > 0;
            total += expected[r][c];
            if (expected[r][c] > 0 || count[r][c] > 0)
                chi += (count[r][c] - expected[r][c]) * (count[r][c] - expected[r][c]) / expected[r][c];
        }
    z = (cbrt(chi / df) - (1 - 2 / (9 * df))) / sqrt(2 / (9 * df));
    ok(fabs(total - drawn) < 2e-4 * MANY && fabs(z) <= 4, "%u %s: directions follow the density (integral %.5f, %.5f drawn, chi-square %.1f of %g, z %.2f)",
       isa, what, total / MANY, drawn / MANY, chi, df, z);
    free_points(&at);
    free_directions(&out);
    free_directions(&toward);
    free(number[0]), free(number[1]), free(number[2]), free(density);
}

/* ---- Mirror-like lobes ---- */

#define MOST_LOBES 16
#define STEPS 1021 /* numbers at which `delta` is asked: (k + 1/2) / STEPS */

/* The lobes of one point: a direction, its chance, and the weight; `seen` counts the numbers that choose it. */
struct outcome {
    double toward[3], probability, weight[3];
    uint32_t seen;
};

struct outcomes {
    uint32_t count;
    struct outcome one[MOST_LOBES];
    double none; /* the chance of none */
};

struct lobe_lanes {
    struct mcr_directions toward;
    double *number, *probability;
    struct mcr_colours weight;
};

static int32_t ask_delta(const struct matter *m, const struct mcr_points *at, const struct lobe_lanes *l)
{
    const double *const number[1] = {l->number};
    void *before = begin(&context, m, at);

    return end(&context, before,
               m->plugin->delta(&host, &context, m->instance, &m->inputs, at, number, &l->toward, l->probability, &l->weight));
}

/* One more lobe of the list, with a share of it; the same lobe again is counted. */
static void add_lobe(struct outcomes *all_of, const double toward[3], double probability, const double weight[3], double share)
{
    for (uint32_t k = 0; k < all_of->count; k++) {
        struct outcome *o = &all_of->one[k];
        if (!memcmp(o->toward, toward, sizeof o->toward) && o->probability == share * probability && o->weight[0] == share * weight[0]) {
            o->seen++;
            return;
        }
    }
    if (all_of->count == MOST_LOBES || share == 0)
        return;
    struct outcome *o = &all_of->one[all_of->count++];
    *o = (struct outcome){.probability = share * probability, .seen = 1};
    for (int c = 0; c < 3; c++)
        o->toward[c] = toward[c], o->weight[c] = share * weight[c];
}

static int none_at(const struct lobe_lanes *l, uint32_t i) { return l->toward.x[i] == 0 && l->toward.y[i] == 0 && l->toward.z[i] == 0; }

/* What a material chooses at each point over all steps, as it tells it. */
static void observe(const struct matter *m, const struct mcr_points *at, struct outcomes *found)
{
    const uint32_t n = at->n;
    struct lobe_lanes l = {directions_array(n), array(n), array(n), colours_array(n)};

    for (uint32_t i = 0; i < n; i++)
        found[i] = (struct outcomes){.none = 0};
    for (uint32_t k = 0; k < STEPS; k++) {
        for (uint32_t i = 0; i < n; i++)
            l.number[i] = (k + 0.5) / STEPS;
        ask_delta(m, at, &l);
        for (uint32_t i = 0; i < n; i++) {
            const double toward[3] = {l.toward.x[i], l.toward.y[i], l.toward.z[i]}, weight[3] = {l.weight.r[i], l.weight.g[i], l.weight.b[i]};
            if (none_at(&l, i))
                found[i].none = l.probability[i];
            else
                add_lobe(&found[i], toward, l.probability[i], weight, 1);
        }
    }
    free_directions(&l.toward);
    free(l.number), free(l.probability);
    free_colours(&l.weight);
}

/* The lobes of a tree: those of its leaves, each with its share. */
static void lobes_of(const struct matter *m, const struct mcr_points *at, const double *share, struct outcomes *right)
{
    const uint32_t n = at->n;

    if (m->kind == LEAF && !(m->traits.does & MCR_MATERIAL_DELTA)) {
        for (uint32_t i = 0; i < n; i++)
            right[i].none += share[i];
    } else if (m->kind == LEAF) {
        struct outcomes *own = malloc(n * sizeof *own);
        observe(m, at, own);
        for (uint32_t i = 0; i < n; i++) {
            right[i].none += share[i] * own[i].none;
            for (uint32_t k = 0; k < own[i].count; k++)
                add_lobe(&right[i], own[i].one[k].toward, own[i].one[k].probability, own[i].one[k].weight, share[i]);
        }
        free(own);
    } else if (m->kind == MASK) {
        uint32_t before[LANES];
        for (uint32_t i = 0; i < n; i++)
            before[i] = right[i].count;
        lobes_of(m->inner[0], at, share, right);
        for (uint32_t i = 0; i < n; i++)
            for (uint32_t k = before[i]; k < right[i].count; k++)
                for (int c = 0; c < 3; c++)
                    right[i].one[k].weight[c] *= opacity_at(m, c, i);
    } else {
        double *part = array(n);
        for (int k = 0; k < 2; k++) {
            for (uint32_t i = 0; i < n; i++)
                part[i] = share[i] * (k ? amount_at(m, i) : 1 - amount_at(m, i));
            lobes_of(m->inner[k], at, part, right);
        }
        free(part);
    }
}

/* Whether an observed lobe is one of those that there are, to 24 roundings. */
static int is_among(const struct outcome *o, const struct outcomes *right)
{
    for (uint32_t k = 0; k < right->count; k++) {
        const struct outcome *r = &right->one[k];
        int same = !memcmp(o->toward, r->toward, sizeof r->toward) && fabs(o->probability - r->probability) <= 24 * ULP;
        for (int c = 0; c < 3; c++)
            same &= fabs(o->weight[c] - r->weight[c]) <= 24 * ULP * fmax(r->weight[c], 1);
        if (same)
            return 1;
    }
    return 0;
}

/*
 * Every lobe that is chosen is one of the leaves', with their direction, chance and weight times its share; it is chosen by as many numbers as its
 * chance says, to one step for each piece that its numbers lie in; none is chosen by the last numbers, and its chance is the one that they tell.
 */
static void test_lobes(const struct matter *m, const char *what)
{
    enum { N = 61 };
    struct mcr_points at = points_array(N);
    struct outcomes *right = calloc(N, sizeof *right), *found = calloc(N, sizeof *found);
    struct lobe_lanes l = {directions_array(N), array(N), array(N), colours_array(N)};
    double *share = array(N);
    uint32_t strangers = 0, rare = 0, missing = 0, none = 0, last = 0;

    memset(&asked, 0, sizeof asked);
    asked.points = at.px;
    for (uint32_t i = 0; i < N; i++)
        share[i] = 1;
    lobes_of(m, &at, share, right);
    observe(m, &at, found);
    for (uint32_t i = 0; i < N; i++) {
        uint32_t expected = 0;
        for (uint32_t k = 0; k < found[i].count; k++) {
            strangers += !is_among(&found[i].one[k], &right[i]);
            rare += fabs(found[i].one[k].seen - found[i].one[k].probability * STEPS) > 1;
        }
        for (uint32_t k = 0; k < right[i].count; k++)
            expected += right[i].one[k].probability * STEPS > 1;
        missing += found[i].count < expected;
        none += found[i].none * STEPS > 1 && fabs(found[i].none - right[i].none) > 24 * ULP;
        none += right[i].none * STEPS > 1 && fabs(found[i].none - right[i].none) > 24 * ULP;
    }
    ok(strangers == 0 && rare == 0 && missing == 0 && none == 0, "%u %s: lobes are those inside, with their shares (%u strangers, %u rare, %u missing, %u none)",
       isa, what, strangers, rare, missing, none);
    for (int side = -1; side <= 1; side++) { /* just below and above where none begins, and the largest number of all */
        for (uint32_t i = 0; i < N; i++)
            l.number[i] = side == 0 ? 1 - 0x1p-53 : fmin(fmax(1 - right[i].none + side * 1e-14, 0), 1 - 0x1p-53);
        ask_delta(m, &at, &l);
        for (uint32_t i = 0; i < N; i++) {
            int expect_none = right[i].none > 2e-14 && (side >= 0 || right[i].none == 1);
            last += expect_none != none_at(&l, i) || (expect_none && fabs(l.probability[i] - right[i].none) > 24 * ULP);
        }
    }
    ok(last == 0 && asked.numbers == 0 && asked.lacking == 0 && asked.elsewhere == 0, "%u %s: none comes last (%u wrong)", isa, what, last);
    ok(guarded(l.toward.x, N) && guarded(l.toward.z, N) && guarded(l.probability, N) && guarded(l.weight.g, N), "%u %s: nothing behind the lanes", isa, what);
    free_points(&at);
    free_directions(&l.toward);
    free_colours(&l.weight);
    free(l.number), free(l.probability), free(right), free(found), free(share);
}

/* ---- Traits, and what cannot be made ---- */

static void test_traits(void)
{
    struct matter plain = cook(&two_sided), whole = cook(&all), light = cook(&lamp), m, over;
    const double opacity[3] = {0.5, 0, 1};
    double right[3] = {0.75 * 1 + 0.25 * 5, 0.75 * 2, 0.75 * 3 + 0.25 * 2};

    mix_of(&m, &whole, &light, 0.25, 0, 8);
    ok(m.traits.does == all.does && m.traits.radiance[0] == right[0] && m.traits.radiance[1] == right[1] && m.traits.radiance[2] == right[2],
       "%u a mix does what both do, and emits the mean", isa);
    mask_of(&over, &m, opacity, 0, 8);
    ok(over.traits.does == all.does && over.traits.radiance[0] == 0.5 * right[0] && over.traits.radiance[1] == 0 && over.traits.radiance[2] == right[2],
       "%u a mask emits where it is opaque", isa);
    unmake(&over);
    unmake(&m);
    mask_of(&over, &plain, opacity, 0, 8);
    ok(over.traits.does == (two_sided.does | MCR_MATERIAL_PASSES), "%u a mask does what its material does, and lets light pass", isa);
    unmake(&over);
}

/* Matter inside is the same whichever of the materials says so; where both do, and differently, the mix is refused. */
static void test_interiors(void)
{
    struct recipe filled = two_sided, same, open = below;
    double *field[] = {&same.index, &same.priority, &same.attenuation[0], &same.attenuation[1], &same.attenuation[2]};
    struct matter one, two, m, over;
    const double opacity[3] = {0.5, 0.5, 0.5};
    uint32_t wrong = 0;

    filled.does |= MCR_MATERIAL_INTERIOR;
    filled.index = 1.5, filled.priority = 2;
    memcpy(filled.attenuation, (double[3]){1, 2, 3}, sizeof filled.attenuation);
    same = filled;
    one = cook(&filled);
    for (int k = 0; k < 2; k++) {
        two = k ? cook(&same) : cook(&open);
        for (int turn = 0; turn < 2; turn++) {
            wrong += mix_of(&m, turn ? &two : &one, turn ? &one : &two, 0.5, 0, 8) != MCR_OK || m.traits.index != 1.5 || m.traits.priority != 2 ||
                     memcmp(m.traits.attenuation, filled.attenuation, sizeof filled.attenuation) || !(m.traits.does & MCR_MATERIAL_INTERIOR);
            unmake(&m);
        }
    }
    ok(wrong == 0, "%u a mix is filled with what one of its materials, or both alike, are filled with", isa);
    mask_of(&over, &one, opacity, 0, 8);
    ok((over.traits.does & MCR_MATERIAL_INTERIOR) && over.traits.index == 1.5 && over.traits.priority == 2 && over.traits.attenuation[2] == 3,
       "%u a mask is filled with what its material is filled with", isa);
    unmake(&over);
    for (int k = 0; k < 5; k++) {
        same = filled;
        *field[k] += 0.5;
        two = cook(&same);
        wrong += mix_of(&m, &one, &two, 0.5, 0, 8) != MCR_E_INVALID || !strstr(context.message, "different matter");
        unmake(&m);
    }
    ok(wrong == 0, "%u a mix of different matter is refused: %s", isa, context.message);
    open.does |= MCR_MATERIAL_THIN;
    two = cook(&open);
    mask_of(&over, &two, opacity, 0, 8);
    for (int turn = 0; turn < 4; turn++) { /* a mask over a thin wall is one */
        const struct matter *thin = turn < 2 ? &two : &over;
        wrong += mix_of(&m, turn % 2 ? thin : &one, turn % 2 ? &one : thin, 0.5, 0, 8) != MCR_E_INVALID || !strstr(context.message, "thin");
        unmake(&m);
    }
    unmake(&over);
    ok(wrong == 0, "%u a mix of matter and of a thin wall is refused: %s", isa, context.message);
}

/* A material that fails, in either place: its failure is handed on, from every operation. */
static void test_failures(void)
{
    struct recipe bad = all;
    struct matter good = cook(&all), failing, m, over;
    const double opacity[3] = {0.5, 0.5, 0.5};
    struct mcr_points at = points_array(8);
    struct mcr_directions toward = directions_array(8);
    struct mcr_colours out = colours_array(8);
    double *number[3] = {numbers(8, 1), numbers(8, 2), numbers(8, 3)};
    struct lobe_lanes l = {toward, number[0], number[1], out};
    uint32_t wrong = 0;

    asked.points = at.px;
    failing = cook(&bad);
    for (int place = 0; place < 3; place++) {
        bad.fails = MCR_OK;
        if (place == 2)
            mask_of(&m, &failing, opacity, 0, 8);
        else
            mix_of(&m, place ? &good : &failing, place ? &failing : &good, 0.5, 0, 8);
        bad.fails = MCR_E_INTERNAL;
        for (enum question q = EVALUATE; q <= ALBEDO; q++)
            wrong += ask(&m, q, &at, &toward, &out) != MCR_E_INTERNAL;
        wrong += ask_delta(&m, &at, &l) != MCR_E_INTERNAL;
        void *before = begin(&context, &m, &at);
        wrong += end(&context, before, m.plugin->draw(&host, &context, m.instance, &m.inputs, &at, (const double *const *)number, &toward, NULL)) !=
                 MCR_E_INTERNAL;
        unmake(&m);
        wrong += (place == 2 ? mask_of(&over, &failing, opacity, 0, 8)
                             : mix_of(&over, place ? &good : &failing, place ? &failing : &good, 0.5, 0, 8)) != MCR_E_INTERNAL;
        wrong += over.instance != NULL;
        unmake(&over);
    }
    ok(wrong == 0, "%u a failure is handed on (%u were not)", isa, wrong);
    free_points(&at);
    free_directions(&toward);
    free_colours(&out);
    free(number[0]), free(number[1]), free(number[2]);
}

/* Nothing but what crosses is left of a mask of opacity 0, and nothing crosses one of opacity 1: exactly, since lights are looked for through it. */
static void test_opacity(void)
{
    struct matter whole = cook(&all), plain = cook(&two_sided), m;
    struct mcr_points at = points_array(LANES);
    struct mcr_directions toward = directions_array(LANES);
    struct mcr_colours out = colours_array(LANES);
    uint32_t wrong = 0;

    asked.points = at.px;
    for (int o = 0; o < 2; o++)
        for (int k = 0; k < 2; k++) {
            mask_of(&m, k ? &whole : &plain, (double[3]){o, o, o}, 0, LANES);
            ask(&m, PASSES, &at, &toward, &out);
            for (uint32_t i = 0; i < LANES; i++)
                wrong += out.r[i] != (o == 0 ? 1 : k ? all.passes[0] : 0);
            unmake(&m);
        }
    ok(wrong == 0, "%u opacity 0 lets all pass, opacity 1 what the material lets pass", isa);
    free_points(&at);
    free_directions(&toward);
    free_colours(&out);
}

/* ---- All of it ---- */

static void test_tree(const struct matter *m, const char *what, int recipes_only)
{
    test_answers(m, what);
    if (m->traits.does & SCATTERS)
        test_draw(m, what, recipes_only);
    if (m->traits.does & MCR_MATERIAL_DELTA)
        test_lobes(m, what);
}

static void test_mixes(void)
{
    struct matter a = cook(&two_sided), b = cook(&below), c = cook(&all), d = cook(&lobes_only), e = cook(&lamp), m, inner, other, over, top;
    const double amount[] = {0, 0.3, 1}, stained[3] = {0.2, 0.5, 0.9};
    char what[80];

    for (int k = 0; k < 3; k++) {
        mix_of(&m, &a, &c, amount[k], 0, LANES);
        snprintf(what, sizeof what, "mix of two that scatter, %g", amount[k]);
        test_tree(&m, what, 1);
        unmake(&m);
        mix_of(&m, &d, &c, amount[k], 0, LANES);
        snprintf(what, sizeof what, "mix of lobes and everything, %g", amount[k]);
        test_tree(&m, what, 1);
        unmake(&m);
        mix_of(&m, &b, &e, amount[k], 0, LANES);
        snprintf(what, sizeof what, "mix of transmission and a lamp, %g", amount[k]);
        test_tree(&m, what, 1);
        unmake(&m);
    }
    mix_of(&m, &c, &a, 0.5, 700, LANES);
    test_tree(&m, "mix, amount varies", 1);
    mix_of(&inner, &d, &b, 0.25, 701, LANES);
    mask_of(&other, &c, stained, 702, LANES);
    mix_of(&over, &inner, &m, 0.6, 0, LANES);
    test_tree(&over, "mix of mixes, amounts vary", 1);
    unmake(&over);
    mix_of(&over, &other, &inner, 0.6, 0, LANES);
    test_tree(&over, "mix of a mask and a mix", 1);
    mask_of(&top, &over, stained, 703, LANES);
    test_tree(&top, "mask over a mix of a mask and a mix", 1);
    unmake(&top);
    unmake(&over);
    unmake(&other);
    mask_of(&over, &e, stained, 704, LANES);
    test_tree(&over, "mask over a lamp", 1);
    unmake(&over);
    unmake(&inner);
    unmake(&m);
    mask_of(&m, &d, stained, 0, LANES);
    test_tree(&m, "mask over lobes", 1);
    unmake(&m);
    mix_of(&m, &a, &c, 0.3, 0, 8);
    test_chi_square(&m, "mix of two that scatter, 0.3");
    mix_of(&inner, &d, &b, 0.25, 0, 8);
    mix_of(&over, &m, &inner, 0.4, 0, 8);
    test_chi_square(&over, "mix of mixes");
    unmake(&over);
    mask_of(&over, &m, stained, 0, 8);
    test_chi_square(&over, "mask over a mix");
    unmake(&over);
    unmake(&inner);
    unmake(&m);
}

/* With materials of the program. */
static void test_program(void)
{
    struct matter mirror, dull, glass, paper, metal, m, inner, over;
    const double stained[3] = {0.2, 0.5, 0.9};

    load_leaf(&mirror, "mirror", 0.9);
    load_leaf(&dull, "mirror", 0.4);
    load_leaf(&glass, "dielectric", 1.5);
    load_leaf(&paper, "lambert", 0.7);
    load_leaf(&metal, "oren-nayar", 0.6);
    mix_of(&m, &mirror, &dull, 0.3, 705, LANES);
    test_tree(&m, "mirror and mirror", 0);
    unmake(&m);
    mix_of(&m, &mirror, &paper, 0.3, 706, LANES);
    test_tree(&m, "mirror and lambert", 0);
    mix_of(&inner, &glass, &paper, 0.2, 0, LANES);
    test_tree(&inner, "glass and lambert", 0);
    mix_of(&over, &m, &inner, 0.6, 0, LANES);
    test_tree(&over, "mirror, glass and lambert", 0);
    unmake(&over);
    mask_of(&over, &mirror, stained, 707, LANES);
    test_tree(&over, "mask over mirror", 0);
    unmake(&over);
    mask_of(&over, &inner, stained, 708, LANES);
    test_tree(&over, "mask over glass and lambert", 0);
    unmake(&over);
    unmake(&inner);
    unmake(&m);
    mix_of(&m, &metal, &paper, 0.35, 0, 8);
    mask_of(&over, &m, stained, 0, 8);
    test_chi_square(&over, "mask over oren-nayar and lambert");
    unmake(&over);
    unmake(&m);
    unmake(&mirror), unmake(&dull), unmake(&glass), unmake(&paper), unmake(&metal);
}

/* A checksum over the bits of all answers of a tree that has everything. */
static uint64_t bits(void)
{
    struct matter a = cook(&two_sided), c = cook(&all), d = cook(&lobes_only), m, inner, over;
    struct mcr_points at = points_array(LANES);
    struct lobe_lanes l = {directions_array(LANES), numbers(LANES, 130), array(LANES), colours_array(LANES)};
    double *number[3] = {numbers(LANES, 131), numbers(LANES, 132), numbers(LANES, 133)};
    struct mcr_colours out = colours_array(LANES);
    uint64_t sum = 0;

    asked.points = at.px;
    mix_of(&m, &a, &c, 0.3, 709, LANES);
    mix_of(&inner, &m, &d, 0.3, 710, LANES);
    mask_of(&over, &inner, (double[3]){0.2, 0.5, 0.9}, 711, LANES);
    ask_delta(&over, &at, &l);
    for (uint32_t i = 0; i < LANES; i++)
        sum = mcr_mix64(sum + mcr_bits(l.toward.x[i]) + 3 * mcr_bits(l.probability[i]) + 5 * mcr_bits(l.weight.g[i]));
    void *before = begin(&context, &over, &at);
    end(&context, before, over.plugin->draw(&host, &context, over.instance, &over.inputs, &at, (const double *const *)number, &l.toward, l.probability));
    for (uint32_t i = 0; i < LANES; i++)
        sum = mcr_mix64(sum + mcr_bits(l.toward.x[i]) + 3 * mcr_bits(l.probability[i]));
    for (enum question q = EVALUATE; q <= ALBEDO; q++) {
        ask(&over, q, &at, &l.toward, &out);
        for (uint32_t i = 0; i < LANES; i++)
            sum = mcr_mix64(sum + mcr_bits(out.r[i]) + (q == DENSITY ? 0 : 3 * mcr_bits(out.g[i])));
    }
    unmake(&over), unmake(&inner), unmake(&m);
    free_points(&at);
    free_directions(&l.toward);
    free_colours(&l.weight);
    free_colours(&out);
    free(l.number), free(l.probability), free(number[0]), free(number[1]), free(number[2]);
    return sum;
}

int main(void)
{
    uint64_t baseline = 0;

    host = stand_in;
    host.material_child_traits = child_traits;
    host.material_child_evaluate = child_evaluate;
    host.material_child_draw = child_draw;
    host.material_child_density = child_density;
    host.material_child_emission = child_emission;
    host.material_child_delta = child_delta;
    host.material_child_passes = child_passes;
    host.material_child_albedo = child_albedo;
    for (isa = MCR_ISA_BASELINE; isa <= MCR_ISA_AVX512; isa++) {
        if (!descriptor_of(load("mix"), isa) || !descriptor_of(load("mask"), isa)) {
            tap_skip("an instruction set", "this processor or build lacks it");
            continue;
        }
        test_mixes();
        test_program();
        test_traits();
        test_interiors();
        test_failures();
        test_opacity();
        baseline = isa == MCR_ISA_BASELINE ? bits() : baseline;
        ok(bits() == baseline, "%u: the bits of the baseline", isa);
    }
    return tap_done();
}
