/* Draws rebounds of a lander from a bounce law, a file of `lithobrake export --to bounce-law`. C99, no dependencies.

   The head of the law says what it was made from, and has its frame, units and ranges. bounce_law.py draws the same
   numbers. A law may be read by several threads at once.

   Copyright (c) 2026, lithobrake contributors. SPDX-License-Identifier: BSD-3-Clause */
#ifndef BOUNCE_LAW_H
#define BOUNCE_LAW_H

#include <stdint.h>

#define BOUNCE_LAW_WHY 512 /* size of the text of a refusal, one sentence */

typedef struct bounce_law bounce_law;

enum bounce_law_status {
    BOUNCE_LAW_OK,
    BOUNCE_LAW_OUTSIDE, /* a condition beyond its range: the law has no answer */
    BOUNCE_LAW_WRONG    /* an argument that cannot be, or no memory */
};

/* How a touchdown ends, in its frame; NaN where the outcome leaves it unknown. */
typedef struct {
    int outcome;        /* its place among bounce_law_outcome; see also leaves and captured */
    int leaves;         /* 1: it leaves with velocity and spin */
    int captured;       /* 1: it is at rest in the ground; with neither nothing is known */
    int row;            /* of the landing whose scatter and direction it has, else -1 */
    double velocity[3]; /* m/s, against the ground */
    double spin[3];     /* rad/s, against the ground */
    double attitude[4]; /* quaternion w, x, y, z that turns the lander's axes into the frame, at the end */
    double duration;    /* s, from first contact to the end */
    double way[3];      /* m, of the centre of mass meanwhile */
} bounce_law_rebound;

/* Reads a law; NULL for another file, another version, and one that was changed, with a sentence in why. */
bounce_law *bounce_law_open(const char *path, char why[BOUNCE_LAW_WHY]);
void bounce_law_close(bounce_law *law);

/* What the law reads of a touchdown, in this order; unit "-" is a pure number. NULL beyond the last. */
int bounce_law_condition_count(const bounce_law *law);
const char *bounce_law_condition(const bounce_law *law, int place);
const char *bounce_law_unit(const bounce_law *law, int place);
double bounce_law_lower(const bounce_law *law, int place);
double bounce_law_upper(const bounce_law *law, int place);
/* Place of a condition by its name, or -1. */
int bounce_law_place(const bounce_law *law, const char *condition);
const char *bounce_law_outcome(const bounce_law *law, int outcome);
/* Fit 0 is that to all landings, the others are to beds drawn with replacement. Keep one over a journey. */
int bounce_law_fit_count(const bounce_law *law);

/* Puts soil and lander of a journey, as a lander of the study had them, among the conditions: draw them once. */
void bounce_law_soil(const bounce_law *law, uint64_t seed, uint64_t journey, double *conditions);

/* Draws one rebound; the same seed and draw give the same numbers whatever was drawn before.
   conditions: [condition_count]. attitude: quaternion w, x, y, z that turns the lander's axes into the frame of the
   touchdown; NULL: any. spin: of the arrival in that frame [rad/s], which bounds the energy; NULL: of the median. */
int bounce_law_draw(const bounce_law *law, const double *conditions, const double attitude[4], const double spin[3],
                    int fit, uint64_t seed, uint64_t draw, bounce_law_rebound *rebound, char why[BOUNCE_LAW_WHY]);

#endif
