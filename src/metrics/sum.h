/* SPDX-License-Identifier: Apache-2.0 */
/* A compensated sum (Neumaier 1974): the error stays near one rounding of the result, however many terms there are. */
#ifndef MCR_METRICS_SUM_H
#define MCR_METRICS_SUM_H

#include <math.h>

struct mcr_sum {
    double high, low;
};

static inline void mcr_sum_add(struct mcr_sum *sum, double term)
{
    double total = sum->high + term;
    sum->low += fabs(sum->high) >= fabs(term) ? (sum->high - total) + term : (term - total) + sum->high;
    sum->high = total;
}

static inline double mcr_sum_value(struct mcr_sum sum)
{
    return isfinite(sum.high) ? sum.high + sum.low : sum.high; /* beyond the range the compensation is NaN */
}

static inline void mcr_sum_join(struct mcr_sum *sum, struct mcr_sum other)
{
    mcr_sum_add(sum, other.high);
    sum->low += other.low;
}

#endif
