/* SPDX-License-Identifier: Apache-2.0 */
/*
 * The distributions against values of 20 digits, computed with python3-mpmath 1.3.0 in 40 digits: betainc (mp.quad of the density from 1000 degrees of
 * freedom on) and erfc, solved by bisection and Newton for the double that each p here is; loggamma; sums of binomials.
 */
#include <math.h>

#include "../tap.h"
#include "base/elementary.h"
#include "base/distributions.h"

#define COUNT(table) (sizeof table / sizeof *table)

static double relative(double value, double truth)
{
    return truth == 0 ? fabs(value) : fabs(value / truth - 1);
}

/* p, degrees of freedom, t */
static const struct {
    double p, df, t;
} student[] = {
    {0.51, 1, 0.031426266043351175749}, {0.75, 1, 1.0},
    {0.8, 1, 1.376381920471173942}, {0.975, 1, 12.706204736174693314},
    {0.995, 1, 63.656741162871524447}, {0.99999, 1, 31830.988608051955305},
    {0.51, 1.5, 0.029355346255080507651}, {0.75, 1.5, 0.87259466254157063604},
    {0.8, 1.5, 1.153364378295468934}, {0.975, 1.5, 6.0166631044279282546},
    {0.995, 1.5, 17.820310514462796682}, {0.99999, 1.5, 1124.5001233846193508},
    {0.51, 2, 0.028289929799333576827}, {0.75, 2, 0.81649658092772603273},
    {0.8, 2, 1.0606601717798215319}, {0.975, 2, 4.3026527297494617894},
    {0.995, 2, 9.9248432009182886403}, {0.99999, 2, 223.6034436345460251},
    {0.51, 2.75, 0.027408100515318750371}, {0.75, 2.75, 0.77395351880432954328},
    {0.8, 2.75, 0.99268769166422674783}, {0.975, 2.75, 3.3525454330616043244},
    {0.995, 2.75, 6.3997165167390242588}, {0.99999, 2.75, 62.899707597622418604},
    {0.51, 3, 0.027211467049118020418}, {0.75, 3, 0.76489232840434528066},
    {0.8, 3, 0.97847231236330465242}, {0.975, 3, 3.1824463052837084359},
    {0.995, 3, 5.8409093097333554113}, {0.99999, 3, 47.927728376006706917},
    {0.51, 4, 0.026670618302639030069}, {0.75, 4, 0.74069708411268263298},
    {0.8, 4, 0.94096457723518136434}, {0.975, 4, 2.7764451051977934898},
    {0.995, 4, 4.6040948713499920459}, {0.99999, 4, 23.332182700855983954},
    {0.51, 5, 0.02634671234227326186}, {0.75, 5, 0.72668684380042265302},
    {0.8, 5, 0.91954378024082621301}, {0.975, 5, 2.5705818356363147828},
    {0.995, 5, 4.0321429835552271793}, {0.99999, 5, 15.546854534969157562},
    {0.51, 7.3, 0.025940173895885106071}, {0.75, 7.3, 0.70957302045699116214},
    {0.8, 7.3, 0.89367135718022713789}, {0.975, 7.3, 2.3450667365477030519},
    {0.995, 7.3, 3.4510316556221846335}, {0.99999, 7.3, 9.6879988052071983806},
    {0.51, 9, 0.025774047507690514148}, {0.75, 9, 0.70272214675132636718},
    {0.8, 9, 0.88340385968553470914}, {0.975, 9, 2.2621571627982049992},
    {0.995, 9, 3.2498355415921257205}, {0.99999, 9, 8.1020578793994242164},
    {0.51, 10, 0.025702893008090309743}, {0.75, 10, 0.69981206131243162734},
    {0.8, 10, 0.87905782855058886168}, {0.975, 10, 2.2281388519862742245},
    {0.995, 10, 3.1692726726169507118}, {0.99999, 10, 7.526954019343624073},
    {0.51, 18, 0.025419562778024998092}, {0.75, 18, 0.68836380646620015792},
    {0.8, 18, 0.862048667989598865}, {0.975, 18, 2.1009220402410380348},
    {0.995, 18, 2.8784404727386077059}, {0.99999, 18, 5.7223311699717923048},
    {0.51, 29, 0.025286049562012943236}, {0.75, 29, 0.68304386082161315009},
    {0.8, 29, 0.85419198588185581838}, {0.975, 29, 2.0452296421327038745},
    {0.995, 29, 2.7563859036706051204}, {0.99999, 29, 5.0855047020118993698},
    {0.51, 30.5, 0.025275330474706287532}, {0.75, 30.5, 0.68261876876727989093},
    {0.8, 30.5, 0.8535654816406548455}, {0.975, 30.5, 2.040869445186320219},
    {0.995, 30.5, 2.7469670637047376126}, {0.99999, 30.5, 5.0391803138278818002},
    {0.51, 99, 0.025132332554701434707}, {0.75, 99, 0.67697598554615262576},
    {0.8, 99, 0.84526703195349698042}, {0.975, 99, 1.9842169515864171029},
    {0.995, 99, 2.6264054572808271827}, {0.99999, 99, 4.4806779580289550148},
    {0.51, 100, 0.025131697537714596623}, {0.75, 100, 0.67695104301147147794},
    {0.8, 100, 0.84523042449101624117}, {0.975, 100, 1.9839715185235518946},
    {0.995, 100, 2.625890521438017607}, {0.99999, 100, 4.4784269029939038901},
    {0.51, 365.25, 0.025086083646517095355}, {0.75, 365.25, 0.67516203635059005843},
    {0.8, 365.25, 0.84260643629111211629}, {0.975, 365.25, 1.9664801186980952663},
    {0.995, 365.25, 2.5893565510186404583}, {0.99999, 365.25, 4.3215618323689913214},
    {0.51, 1000, 0.025075180209466441629}, {0.75, 1000, 0.67473516460700943738},
    {0.8, 1000, 0.84198082216242871548}, {0.975, 1000, 1.9623390808264081039},
    {0.995, 1000, 2.5807546980659507706}, {0.99999, 1000, 4.2854376826539882154},
    {0.51, 12345.6, 0.025069416231540805203}, {0.75, 12345.6, 0.67450962297382066663},
    {0.8, 12345.6, 0.84165034944270142856}, {0.975, 12345.6, 1.9601561582595101492},
    {0.995, 12345.6, 2.5762276044252137194}, {0.99999, 12345.6, 4.2665486374480147019},
    {0.51, 100000, 0.025068970970446705394}, {0.75, 100000, 0.67449220355329220583},
    {0.8, 100000, 0.84162482799690100547}, {0.975, 100000, 1.9599877075346092587},
    {0.995, 100000, 2.5758784699083749963}, {0.99999, 100000, 4.2650954031823411352},
    {0.51, 1000000, 0.025068914529877548599}, {0.75, 1000000, 0.67448999553108737862},
    {0.8, 1000000, 0.8416215930139841707}, {0.975, 1000000, 1.9599663568141066553},
    {0.995, 1000000, 2.5758342201053338472}, {0.99999, 1000000, 4.2649112540706758118},
    {0.51, 1e9, 0.025068908264982223738}, {0.75, 1e9, 0.67448975044141666943},
    {0.8, 1e9, 0.84162123393235528611}, {0.975, 1e9, 1.9599639869123250887},
    {0.995, 1e9, 2.5758293084654480613}, {0.99999, 1e9, 4.2648908143839011371},
};

static const struct {
    double p, z;
} normal[] = {
    {1e-300, -37.047096299361199237}, {1e-20, -9.2623400897984075796}, {0.001, -3.0902323061678135354},
    {0.025, -1.9599639845400542118}, {0.3, -0.52440051270804081597}, {0.42, -0.20189347914185089071},
    {0.4999, -0.00025066283008800749239}, {0.501, 0.0025066308995717662317}, {0.6, 0.25334710313579974132},
    {0.61, 0.2793190344474541306}, {0.9, 1.2815515655446005935}, {0.975, 1.9599639845400538556},
    {0.99999999, 5.6120012433055049826},
};

/* z, P(Z > z) */
static const struct {
    double z, upper;
} normal_tail[] = {
    {0.5, 0.30853753872598689636}, {1.999, 0.022804176932658882735}, {2.0, 0.0227501319481792072},
    {2.5, 0.006209665325776135167}, {6, 9.865876450376981407e-10}, {30, 4.9067139271481870595e-198},
};

/* t, degrees of freedom, P(T > t) */
static const struct {
    double t, df, upper;
} student_tail[] = {
    {0.0, 1, 0.5}, {1.0, 3, 0.19550110947788532096},
    {-2.0, 4.5, 0.94587104640943748668}, {12.0, 9, 3.8499431114928260166e-7},
    {40.0, 2.5, 0.000070978171452466914564}, {1000000.0, 1, 3.1830988618368456824e-7},
    {5.0, 1000, 3.3836281823243151909e-7},
};

/* a, b, x, I_x(a, b), 1 - I_x(a, b) */
static const struct {
    double a, b, x, lower, upper;
} beta[] = {
    {0.5, 0.5, 0.3, 0.36901011956554537504, 0.63098988043445462496},
    {2.5, 7.25, 0.4, 0.84987023013411590614, 0.15012976986588409386},
    {30, 40, 0.6, 0.99807411120246101958, 0.0019258887975389804199},
    {0.5, 500, 0.001, 0.68268955269028263533, 0.31731044730971736467},
    {1000.5, 3, 0.999, 0.91933023279757229376, 0.080669767202427706239},
    {1, 1, 0.125, 0.125, 0.875},
};

/* x, log gamma(x) */
static const struct {
    double x, log_gamma;
} gammas[] = {
    {1e-10, 23.025850929882735237}, {0.1, 2.252712651734205902}, {0.5, 0.57236494292470008707},
    {1.5, -0.12078223763524522235}, {2.5, 0.28468287047291915963}, {10, 12.801827480081469611},
    {15.999, 27.89653040276015035}, {16, 27.899271383840891566}, {100.25, 360.28455963776423497},
    {5e5, 6061176.0464591755665}, {1e10, 220258509288.81058147},
};

/* k, n, P(at most k heads in n) */
static const struct {
    double k, n, lower;
} coin[] = {
    {0, 5, 0.03125}, {1, 8, 0.03515625}, {1, 9, 0.01953125},
    {2, 10, 0.0546875}, {40, 100, 0.028443966820490395835},
};

static void test_student(void)
{
    double few = 0, many = 0, mirrored = 0, there_and_back = 0;
    for (size_t i = 0; i < COUNT(student); i++) {
        double p = student[i].p, df = student[i].df, t = mcr_student_quantile(p, df), error = relative(t, student[i].t);
        if (df < 1e4)
            few = fmax(few, error);
        else
            many = fmax(many, error);
        mirrored = fmax(mirrored, relative(-mcr_student_quantile(1 - p, df), mcr_student_quantile(1 - (1 - p), df)));
        there_and_back = fmax(there_and_back, relative(mcr_student_upper(t, df), 1 - p));
    }
    ok(few <= 1e-13, "t quantiles below 10,000 degrees of freedom: relative error %.1e", few);
    ok(many <= 1e-13, "t quantiles from there on: relative error %.1e", many);
    ok(mirrored <= 1e-15 && there_and_back <= 1e-12, "quantiles are odd about one half (%.1e) and the tail of the quantile is p (%.1e)", mirrored,
       there_and_back);
    ok(mcr_student_quantile(0.5, 3) == 0 && mcr_student_quantile(0.5, MCR_INFINITY) == 0, "the median is 0");
    ok(relative(mcr_student_quantile(0.975, MCR_INFINITY), mcr_normal_quantile(0.975)) == 0, "infinite degrees of freedom: normal");
    ok(relative(mcr_student_quantile(1e-100, 1), -1e100 / MCR_PI) < 1e-12 && relative(mcr_student_quantile(1e-100, 40), -1.7e4) < 1,
       "far tails: %g, %g", mcr_student_quantile(1e-100, 1), mcr_student_quantile(1e-100, 40));
    double seam = relative(mcr_student_quantile(0.975, 0.9999999e7), mcr_student_quantile(0.975, 1.0000001e7));
    ok(seam < 1e-12, "no seam where the expansion takes over (%.1e)", seam);
}

static void test_tails(void)
{
    double worst = 0;
    for (size_t i = 0; i < COUNT(student_tail); i++)
        worst = fmax(worst, relative(mcr_student_upper(student_tail[i].t, student_tail[i].df), student_tail[i].upper));
    ok(worst <= 1e-12, "t tails: relative error %.1e", worst);
    worst = 0;
    for (size_t i = 0; i < COUNT(normal_tail); i++)
        worst = fmax(worst, relative(mcr_normal_upper(normal_tail[i].z), normal_tail[i].upper));
    ok(worst <= 1e-12, "normal tails: relative error %.1e", worst);
    worst = 0;
    for (size_t i = 0; i < COUNT(normal); i++)
        worst = fmax(worst, relative(mcr_normal_quantile(normal[i].p), normal[i].z));
    ok(worst <= 1e-12, "normal quantiles: relative error %.1e", worst);
    worst = 0;
    for (size_t i = 0; i < COUNT(coin); i++)
        worst = fmax(worst, relative(mcr_coin_lower(coin[i].k, coin[i].n), coin[i].lower));
    ok(worst <= 1e-12 && mcr_coin_lower(-1, 5) == 0 && mcr_coin_lower(5, 5) == 1, "tosses of a coin: relative error %.1e", worst);
}

static void test_gamma(void)
{
    double worst = 0, small = 0, x = 1e-10;
    for (size_t i = 0; i < COUNT(beta); i++) {
        struct mcr_beta b = mcr_beta_regularised(beta[i].a, beta[i].b, beta[i].x, 1 - beta[i].x);
        worst = fmax(worst, fmax(relative(b.lower, beta[i].lower), relative(b.upper, beta[i].upper)));
    }
    ok(worst <= 1e-12, "incomplete beta and its complement: relative error %.1e", worst);
    worst = 0;
    for (size_t i = 0; i < COUNT(gammas); i++)
        worst = fmax(worst, relative(mcr_log_gamma(gammas[i].x), gammas[i].log_gamma));
    ok(worst <= 1e-12 && fabs(mcr_log_gamma(1)) <= 1e-14 && fabs(mcr_log_gamma(2)) <= 1e-14, "log gamma: relative error %.1e", worst);
    for (; x < 0.9; x *= 1.7)
        small = fmax(small, fmax(relative(mcr_log1p(x), log1p(x)), relative(mcr_log1p(-x), log1p(-x))));
    ok(small <= 1e-15 && mcr_log1p(0) == 0 && mcr_log1p(-1) == -INFINITY, "log(1 + x) against C's: relative error %.1e", small);
}

static void test_domains(void)
{
    ok(isnan(mcr_student_quantile(0.9, 0)) && isnan(mcr_student_quantile(0.9, NAN)) && isnan(mcr_student_quantile(1, 3)) &&
       isnan(mcr_student_quantile(NAN, 3)) && isnan(mcr_student_upper(1, -1)) && isnan(mcr_student_upper(NAN, 3)), "Student outside its domain is NaN");
    ok(isnan(mcr_normal_quantile(0)) && isnan(mcr_normal_quantile(1)) && isnan(mcr_normal_upper(NAN)) && isnan(mcr_log_gamma(0)) &&
       isnan(mcr_beta_regularised(0, 1, 0.5, 0.5).lower), "the others too");
    ok(mcr_student_upper(INFINITY, 3) == 0 && mcr_student_upper(-INFINITY, 3) == 1 && mcr_normal_upper(INFINITY) == 0 &&
       mcr_normal_upper(-INFINITY) == 1,
       "tails at infinity");
}

int main(void)
{
    test_student();
    test_tails();
    test_gamma();
    test_domains();
    return tap_done();
}
