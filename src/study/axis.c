/* SPDX-License-Identifier: Apache-2.0 */
#include "study/axis.h"

#include <math.h>

#include "base/elementary.h"

#define LN10 2.302585092994046

static double log10_of(double x)
{
    return mcr_log(x) / LN10;
}

static double ten_to(double x)
{
    return mcr_pow(10, x);
}

static int usable(double value)
{
    return value > 0 && value <= 1e300;
}

void mcr_axis_init(struct mcr_axis *axis)
{
    *axis = (struct mcr_axis){.least = NAN, .greatest = NAN};
}

void mcr_axis_add(struct mcr_axis *axis, double value)
{
    if (!usable(value) || value < 1e-300)
        return;
    if (!(axis->least <= value))
        axis->least = value;
    if (!(axis->greatest >= value))
        axis->greatest = value;
}

void mcr_axis_add_end(struct mcr_axis *axis, double value, double end)
{
    if (!usable(value) || isnan(end))
        return;
    mcr_axis_add(axis, end < value / 4 ? value / 4 : end > value * 4 ? value * 4 : end);
}

static void add_tick(struct mcr_axis *axis, double tick)
{
    if (axis->ticks < MCR_AXIS_TICKS && tick >= axis->low * (1 - 1e-9) && tick <= axis->high * (1 + 1e-9))
        axis->tick[axis->ticks++] = tick;
}

/* Every `step`th power of ten. */
static void decades(struct mcr_axis *axis, double low, double high, int step)
{
    axis->powers = 1;
    for (int n = (int)ceil(ceil(low - 1e-9) / step) * step; n <= high + 1e-9; n += step)
        add_tick(axis, ten_to(n));
}

/* 1, 2 and 5 times powers of ten. */
static void one_two_five(struct mcr_axis *axis, double low, double high)
{
    for (int n = (int)floor(low); n <= high; n++)
        for (int i = 0; i < 3; i++)
            add_tick(axis, (i == 0 ? 1 : i == 1 ? 2 : 5) * ten_to(n));
}

/* Equal steps of 1, 2 or 5 times a power of ten. */
static void equal_steps(struct mcr_axis *axis, uint32_t wanted)
{
    double raw = (axis->high - axis->low) / wanted, power = ten_to(floor(log10_of(raw))), ratio = raw / power;
    double step = power * (ratio <= 1 ? 1 : ratio <= 2 ? 2 : ratio <= 5 ? 5 : 10);
    for (double n = ceil(axis->low / step); n * step <= axis->high && axis->ticks < MCR_AXIS_TICKS; n++)
        add_tick(axis, n * step);
}

void mcr_axis_finish(struct mcr_axis *axis, uint32_t wanted)
{
    double low = isnan(axis->least) ? -1 : log10_of(axis->least), high = isnan(axis->greatest) ? 1 : log10_of(axis->greatest);
    double margin = 0.06 * (high - low);
    if (high - low < 0.15) /* a single value, nearly: half a factor of 1.6 to each side */
        margin = 0.1;
    low -= margin;
    high += margin;
    axis->low = ten_to(low);
    axis->high = ten_to(high);
    axis->ticks = 0;
    axis->powers = 0;
    if (high - low >= 2.2)
        decades(axis, low, high, (int)ceil((high - low) / wanted));
    else if (high - low >= 0.9)
        one_two_five(axis, low, high);
    else
        equal_steps(axis, wanted);
}

void mcr_axis_set_ticks(struct mcr_axis *axis, const double *value, uint32_t count, double share)
{
    double last = -1;
    axis->ticks = 0;
    axis->powers = 0;
    for (uint32_t i = 0; i < count; i++) {
        double place = mcr_axis_place(axis, value[i]);
        if (!(place >= 0 && place <= 1 && place >= last + share))
            continue;
        add_tick(axis, value[i]);
        last = place;
    }
}

double mcr_axis_place(const struct mcr_axis *axis, double value)
{
    return usable(value) ? mcr_log(value / axis->low) / mcr_log(axis->high / axis->low) : NAN;
}

void mcr_axis_label(const struct mcr_axis *axis, double tick, struct mcr_text *out)
{
    double power = log10_of(tick), whole = floor(power + 0.5);
    int plain = axis->low >= 0.0009 && axis->high <= 2e5;
    if (plain) { /* the digits that ticks of equal steps differ in */
        mcr_text_short(out, floor(tick * 1e6 + 0.5) / 1e6, 12);
        return;
    }
    if (!axis->powers || fabs(power - whole) > 1e-6) {
        whole = floor(power + 1e-9);
        mcr_text_short(out, floor(tick / ten_to(whole) * 1e6 + 0.5) / 1e6, 7);
        mcr_text_put(out, "\u00b7");
    }
    mcr_text_printf(out, "10<tspan class=\"up\" dy=\"-0.45em\">%s%d</tspan>", whole < 0 ? "\u2212" : "", (int)fabs(whole));
}
