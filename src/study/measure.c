/* SPDX-License-Identifier: Apache-2.0 */
#include <math.h>
#include <stdio.h>

#include "study/work.h"

/* Renders and measures. 0, 1 stopped, -1 with the reason. */
int mcr_study_measure(struct mcr_study_work *work, const struct mcr_shot_settings *settings, uint32_t reference, struct mcr_shot *shot,
                   double metric[MCR_METRIC_COUNT], char *error, size_t length)
{
    struct mcr_comparison comparison;
    int status = mcr_shot_render(&work->setup, settings, shot, error, length);
    if (status)
        return status;
    if (mcr_metrics_compare(shot->image, work->reference_image[reference], &work->plan->how, work->plan->metrics, &comparison)) {
        snprintf(error, length, "an image cannot be compared with the reference: %s", comparison.error);
        return -1;
    }
    for (int m = 0; m < MCR_METRIC_COUNT; m++)
        metric[m] = work->plan->metrics >> m & 1 ? comparison.whole.value[m] : (double)NAN;
    return 0;
}

/* Pages, caches and the processor's clock, before the first run that counts. */
void mcr_study_warm_up(struct mcr_study_work *work)
{
    struct mcr_study_settings settings = work->study.cell[0].settings;
    struct mcr_shot_settings shot_settings;
    struct mcr_shot shot = {0};
    char unused[256];
    settings.spp = 1;
    mcr_study_shot(work, &settings, work->plan->first_seed, &shot_settings);
    mcr_shot_render(&work->setup, &shot_settings, &shot, unused, sizeof unused);
    mcr_shot_fini(&shot);
}
