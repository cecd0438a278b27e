/* Draws from a bounce law for a test: a line of numbers in, a line of numbers out, or the sentence of a refusal. */
#include <math.h>
#include <stdio.h>

#include "bounce_law.h"

int main(int count, char **words) {
    char why[BOUNCE_LAW_WHY] = "";
    bounce_law *law = count == 2 ? bounce_law_open(words[1], why) : NULL;
    double x[64], attitude[4], spin[3];
    unsigned long long seed, draw;
    int fit;
    if (!law) return fprintf(stderr, "%s\n", why), 1;
    /* seed, draw, fit, attitude and spin, nan for none, then the conditions. */
    while (scanf("%llu %llu %d", &seed, &draw, &fit) == 3) {
        bounce_law_rebound one;
        for (int k = 0; k < 4; k++) if (scanf("%lf", attitude + k) != 1) return 2;
        for (int k = 0; k < 3; k++) if (scanf("%lf", spin + k) != 1) return 2;
        for (int k = 0; k < bounce_law_condition_count(law); k++) if (scanf("%lf", x + k) != 1) return 2;
        if (bounce_law_draw(law, x, isnan(attitude[0]) ? NULL : attitude, isnan(spin[0]) ? NULL : spin, fit, seed, draw,
                            &one, why)) {
            printf("%s\n", why);
            continue;
        }
        printf("%d %d", one.outcome, one.row);
        for (int k = 0; k < 3; k++) printf(" %.17g", one.velocity[k]);
        for (int k = 0; k < 3; k++) printf(" %.17g", one.spin[k]);
        for (int k = 0; k < 4; k++) printf(" %.17g", one.attitude[k]);
        printf(" %.17g", one.duration);
        for (int k = 0; k < 3; k++) printf(" %.17g", one.way[k]);
        bounce_law_soil(law, seed, draw, x);
        for (int k = 0; k < bounce_law_condition_count(law); k++) printf(" %.17g", x[k]);
        printf("\n");
    }
    bounce_law_close(law);
    return 0;
}
