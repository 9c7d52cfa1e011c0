/* SPDX-License-Identifier: Apache-2.0 */
/* uniform, cosine and their mixture: directions and densities, each instruction set. Fixed numbers: every result is a constant. */
#include "stand_in.h"

#define U 0x1p-53

static struct mcr_context context;
static const char *name;
static uint32_t isa;

static double dot(const struct mcr_points *at, uint32_t i, const struct mcr_directions *d)
{
    return at->nx[i] * d->x[i] + at->ny[i] * d->y[i] + at->nz[i] * d->z[i];
}

/* Unit, above the horizon, the density of the draw that of `density` to the bit, nothing written behind the lanes. */
static void test_draw(struct mcr_child *child, uint32_t n)
{
    struct mcr_points at = points_array(n);
    struct mcr_directions out = directions_array(n), again = directions_array(n);
    double *number[3] = {numbers(n, 10), numbers(n, 11), numbers(n, 12)}, *density = array(n), *same = array(n), worst = 0;
    uint32_t wrong = 0, below = 0;

    stand_in_draw(&stand_in, &context, child, 0, &at, (const double *const *)number, &out, density);
    stand_in_density(&stand_in, &context, child, 0, &at, &out, same);
    stand_in_draw(&stand_in, &context, child, 0, &at, (const double *const *)number, &again, NULL);
    for (uint32_t i = 0; i < n; i++) {
        long double x = out.x[i], y = out.y[i], z = out.z[i];
        double error = (double)fabsl(sqrtl(x * x + y * y + z * z) - 1);

        worst = error > worst ? error : worst;
        below += !(dot(&at, i, &out) > 0);
        wrong += density[i] != same[i] || !(density[i] > 0) || again.x[i] != out.x[i] || again.y[i] != out.y[i] || again.z[i] != out.z[i];
    }
    ok(worst <= 4 * U, "%s %u: %u directions are unit to 4u (worst %.2fu)", name, isa, n, worst / U);
    ok(below == 0, "%s %u: all are above the horizon", name, isa);
    ok(wrong == 0, "%s %u: draw and density agree to the bit, with and without density", name, isa);
    ok(guarded(out.x, n) && guarded(out.y, n) && guarded(out.z, n) && guarded(density, n) && guarded(same, n),
       "%s %u: nothing is written behind lane %u", name, isa, n);
    free_points(&at);
    free_directions(&out);
    free_directions(&again);
    free(number[0]), free(number[1]), free(number[2]), free(density), free(same);
}

/*
 * The density over the sphere by the midpoint rule on 256 x 512 cells of equal solid angle about each normal's axis: 1. The
 * densities are smooth in height and even in azimuth, so that the rule's error is below 1e-12 for them; the jump at the horizon lies
 * on a border of cells. Directions are turned with the normal by code of this test's own.
 */
static void test_integral(struct mcr_child *child)
{
    const uint32_t rows = 256, columns = 512;
    struct mcr_points at = points_array(columns);
    struct mcr_directions toward = directions_array(columns);
    double *density = array(columns), worst = 0;

    for (uint32_t p = 0; p < 8; p++) {
        double n[3] = {at.nx[p], at.ny[p], at.nz[p]}, t[3], b[3], sum = 0, length;
        int least = fabs(n[0]) < 0.6 ? 0 : 1;

        for (int c = 0; c < 3; c++)
            t[c] = (c == least) - n[c] * n[least];
        length = sqrt(t[0] * t[0] + t[1] * t[1] + t[2] * t[2]);
        for (int c = 0; c < 3; c++)
            t[c] /= length;
        for (int c = 0; c < 3; c++)
            b[c] = n[(c + 1) % 3] * t[(c + 2) % 3] - n[(c + 2) % 3] * t[(c + 1) % 3];
        for (uint32_t i = 0; i < columns; i++)
            ((double *)at.nx)[i] = n[0], ((double *)at.ny)[i] = n[1], ((double *)at.nz)[i] = n[2];
        for (uint32_t r = 0; r < rows; r++) {
            double z = 2 * (r + 0.5) / rows - 1, s = sqrt(1 - z * z);

            for (uint32_t i = 0; i < columns; i++) {
                double x = s * cos(2 * M_PI * i / columns), y = s * sin(2 * M_PI * i / columns);
                toward.x[i] = x * t[0] + y * b[0] + z * n[0];
                toward.y[i] = x * t[1] + y * b[1] + z * n[1];
                toward.z[i] = x * t[2] + y * b[2] + z * n[2];
            }
            stand_in_density(&stand_in, &context, child, 0, &at, &toward, density);
            for (uint32_t i = 0; i < columns; i++)
                sum += density[i] * 4 * M_PI / rows / columns;
        }
        worst = fabs(sum - 1) <= worst ? worst : fabs(sum - 1);
        free_points(&at);
        at = points_array(columns);
    }
    ok(worst <= 1e-12, "%s %u: the density integrates to 1 (error %.1e)", name, isa, worst);
    free_points(&at);
    free_directions(&toward);
    free(density);
}

/*
 * Chi-square of 2^17 directions in 16 x 32 cells of height and azimuth about one slanted normal against the density, which is that of
 * height alone: the share of heights below h is h for uniform, h^2 for cosine. chi^2 with 511 degrees of freedom as a normal
 * deviate (Wilson and Hilferty 1931).
 */
static void test_chi_square(struct mcr_child *child, double uniform_share)
{
    enum { ROWS = 16, COLUMNS = 32, N = 1 << 17 };
    struct mcr_points at = points_array(N);
    struct mcr_directions out = directions_array(N);
    double *number[3] = {numbers(N, 20), numbers(N, 21), numbers(N, 22)}, chi = 0, df = ROWS * COLUMNS - 1, z;
    double n[3] = {at.nx[9], at.ny[9], at.nz[9]}, tx, ty, tz, bx, by, bz;
    static uint32_t count[ROWS][COLUMNS];

    memset(count, 0, sizeof count);
    for (uint32_t i = 0; i < N; i++)
        ((double *)at.nx)[i] = n[0], ((double *)at.ny)[i] = n[1], ((double *)at.nz)[i] = n[2];
    mcr_basis(n[0], n[1], n[2], &tx, &ty, &tz, &bx, &by, &bz);
    stand_in_draw(&stand_in, &context, child, 0, &at, (const double *const *)number, &out, NULL);
    for (uint32_t i = 0; i < N; i++) {
        double h = dot(&at, i, &out), azimuth = atan2(out.x[i] * bx + out.y[i] * by + out.z[i] * bz, out.x[i] * tx + out.y[i] * ty + out.z[i] * tz);
        int row = (int)(h * ROWS), column = (int)((azimuth / (2 * M_PI) + 0.5) * COLUMNS);

        count[row < ROWS ? row : ROWS - 1][column < COLUMNS ? column : COLUMNS - 1]++;
    }
    for (int r = 0; r < ROWS; r++)
        for (int c = 0; c < COLUMNS; c++) {
            double low = (double)r / ROWS, high = (r + 1.0) / ROWS;
            double share = uniform_share * (high - low) + (1 - uniform_share) * (high * high - low * low), expected = N * share / COLUMNS;
            chi += (count[r][c] - expected) * (count[r][c] - expected) / expected;
        }
    z = (cbrt(chi / df) - (1 - 2 / (9 * df))) / sqrt(2 / (9 * df));
    ok(fabs(z) <= 4, "%s %u: directions follow the density (chi-square %.1f of %g, z %.2f)", name, isa, chi, df, z);
    free_points(&at);
    free_directions(&out);
    free(number[0]), free(number[1]), free(number[2]);
}

/* The corners of the square of numbers, and directions that cannot be drawn. */
static void test_extremes(struct mcr_child *child)
{
    static const double edge[4] = {0, 0.5, 1 - 0x1p-53, 0x1p-53};
    struct mcr_points at = points_array(64);
    struct mcr_directions out = directions_array(64), nothing = directions_array(64);
    double *number[3] = {array(64), array(64), array(64)}, *density = array(64), *same = array(64);
    uint32_t wrong = 0;

    for (uint32_t i = 0; i < 64; i++) {
        number[0][i] = edge[i / 16], number[1][i] = edge[i / 4 % 4], number[2][i] = edge[i % 4];
        nothing.x[i] = nothing.y[i] = nothing.z[i] = 0;
    }
    stand_in_draw(&stand_in, &context, child, 0, &at, (const double *const *)number, &out, density);
    stand_in_density(&stand_in, &context, child, 0, &at, &out, same);
    for (uint32_t i = 0; i < 64; i++) {
        int drawn = density[i] > 0 && isfinite(density[i]) && fabs(out.x[i] * out.x[i] + out.y[i] * out.y[i] + out.z[i] * out.z[i] - 1) <= 1e-15;
        int not_drawn = density[i] == 0 && out.x[i] == 0 && out.y[i] == 0 && out.z[i] == 0;
        wrong += (!drawn && !not_drawn) || same[i] != density[i];
    }
    ok(wrong == 0, "%s %u: numbers at the borders give a direction or nothing", name, isa);
    stand_in_density(&stand_in, &context, child, 0, &at, &nothing, density);
    for (uint32_t i = wrong = 0; i < 64; i++) {
        wrong += density[i] != 0;
        nothing.x[i] = -at.nx[i], nothing.y[i] = -at.ny[i], nothing.z[i] = -at.nz[i];
    }
    stand_in_density(&stand_in, &context, child, 0, &at, &nothing, density);
    for (uint32_t i = 0; i < 64; i++)
        wrong += density[i] != 0;
    ok(wrong == 0, "%s %u: density 0 for (0, 0, 0) and from below", name, isa);
    free_points(&at);
    free_directions(&out);
    free_directions(&nothing);
    free(number[0]), free(number[1]), free(number[2]), free(density), free(same);
}

/* A checksum over the bits of many draws and densities. */
static uint64_t bits_of(struct mcr_child *child)
{
    const uint32_t n = 4099;
    struct mcr_points at = points_array(n);
    struct mcr_directions out = directions_array(n);
    double *number[3] = {numbers(n, 30), numbers(n, 31), numbers(n, 32)}, *density = array(n);
    uint64_t sum = 0;

    stand_in_draw(&stand_in, &context, child, 0, &at, (const double *const *)number, &out, density);
    for (uint32_t i = 0; i < n; i++)
        sum = mcr_mix64(sum + mcr_bits(out.x[i]) + 3 * mcr_bits(out.y[i]) + 5 * mcr_bits(out.z[i]) + 7 * mcr_bits(density[i]));
    free_points(&at);
    free_directions(&out);
    free(number[0]), free(number[1]), free(number[2]), free(density);
    return sum;
}

int main(void)
{
    const struct mcr_plugin *plugin[3] = {load("uniform"), load("cosine"), load("mixture")};
    static const char *const names[3] = {"uniform", "cosine", "mixture"};
    static const double uniform_share[3] = {1, 0, 0.25};
    uint64_t first_bits[3] = {0};

    for (isa = MCR_ISA_BASELINE; isa <= MCR_ISA_AVX512; isa++) {
        struct mcr_child child[3];
        const struct mcr_child *inner[2] = {&child[0], &child[1]};
        const double weight[2] = {2, 6};

        for (uint32_t k = 0; k < 3; k++) {
            const struct mcr_directions_plugin *descriptor = descriptor_of(plugin[k], isa);

            name = names[k];
            if (!descriptor) {
                tap_skip(name, "this processor or build lacks the instruction set");
                continue;
            }
            ok(make_child(&child[k], &context, descriptor, 0, k == 2 ? 2 : 0, inner, weight) == 0 && child[k].technique_count == 1 &&
                   child[k].technique[0].kind == MCR_TECHNIQUE_DIRECTION && child[k].technique[0].covers == MCR_COVERS_REFLECTION &&
                   child[k].technique[0].continues == 1 && child[k].technique[0].dimensions == (k == 2 ? 3 : 2),
               "%s %u: created, with one technique", name, isa);
            for (uint32_t n = 1; n <= 17; n += 8)
                test_draw(&child[k], n);
            test_draw(&child[k], 200001);
            test_integral(&child[k]);
            test_chi_square(&child[k], uniform_share[k]);
            test_extremes(&child[k]);
            if (isa == MCR_ISA_BASELINE)
                first_bits[k] = bits_of(&child[k]);
            ok(bits_of(&child[k]) == first_bits[k], "%s %u: the bits of the baseline", name, isa);
            if (k < 2) {
                struct mcr_child refused;
                ok(make_child(&refused, &context, descriptor, 0, 1, inner, weight) == MCR_E_INVALID && context.message[0],
                   "%s %u: children are refused: %s", name, isa, context.message);
            }
        }
        if (descriptor_of(plugin[2], isa))
            destroy_child(&child[2]);
    }
    return tap_done();
}
