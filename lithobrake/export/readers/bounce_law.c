/* See bounce_law.h. Copyright (c) 2026, lithobrake contributors. SPDX-License-Identifier: BSD-3-Clause */
#include "bounce_law.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MAGIC "lithobrake bounce law "
#define VERSION "1"
#define MOST_BLOCKS 64
#define MOST_SIZES 4

/* Places of the random numbers of a draw: outcome, row, four of its smoothing, row at rest, three of the attitude;
   soil. */
enum { OUTCOME, ROW, NOISE, REST = 6, ATTITUDE, SOIL = 10 };
enum { SPEED, ELEVATION, RATE, OUTPUTS }; /* what has a location and a scale, in its order */

static const double PI = 3.14159265358979323846;

typedef struct {
    const char *name;
    char **words;    /* of a block of names */
    double *numbers; /* of a block of numbers */
    size_t size[MOST_SIZES], count;
} block;

struct bounce_law {
    char *text; /* the file; names of blocks and words point into it */
    block blocks[MOST_BLOCKS];
    int block_count;
    /* Numbers that are asked for at every draw, found once. */
    size_t conditions, outcomes, fits, inputs, plain, terms, degree, rows, leaving, resting, soils, soil_places, axes;
    char **condition, **unit, **outcome;
    const double *lower, *upper, *is_log, *zero, *slope, *center, *spread, *indices, *widths, *row_inputs, *distant;
    const double *location, *log_scale, *limits, *residuals, *weights, *smoothing, *root, *intercepts, *slopes, *never;
    const double *output_lower, *output_upper, *outcome_places, *left, *rested, *axis, *kind, *ranges;
    const double *bound, *bound_places, *bound_medians, *soil, *soil_place;
};

static uint64_t mixed(uint64_t x) {
    x = (x ^ (x >> 30)) * UINT64_C(0xBF58476D1CE4E5B9);
    x = (x ^ (x >> 27)) * UINT64_C(0x94D049BB133111EB);
    return x ^ (x >> 31);
}

/* The number between 0 and 1, neither included, at a place of a draw: SplitMix64, counted, not stepped. */
static double uniform(uint64_t seed, uint64_t draw, uint64_t place) {
    const uint64_t step = UINT64_C(0x9E3779B97F4A7C15);
    uint64_t start = mixed(mixed(seed + step) + step * (draw + 1));
    return ((double)(mixed(start + step * (place + 1)) >> 12) + 0.5) * 0x1p-52;
}

/* ---- reading ---- */

static uint32_t crc32_of(const char *text, size_t length) {
    uint32_t sum = 0xFFFFFFFFu;
    for (size_t k = 0; k < length; k++) {
        sum ^= (unsigned char)text[k];
        for (int bit = 0; bit < 8; bit++) sum = (sum >> 1) ^ (sum & 1u ? 0xEDB88320u : 0u);
    }
    return ~sum;
}

static char *whole_file(const char *path, size_t *length) {
    FILE *file = fopen(path, "rb");
    char *text = NULL;
    long size;
    if (!file) return NULL;
    if (!fseek(file, 0, SEEK_END) && (size = ftell(file)) >= 0 && !fseek(file, 0, SEEK_SET)) {
        text = malloc((size_t)size + 1);
        if (text && fread(text, 1, (size_t)size, file) != (size_t)size) {
            free(text);
            text = NULL;
        }
        if (text) text[*length = (size_t)size] = '\0';
    }
    fclose(file);
    return text;
}

/* Checks first and last line, and ends the text before the last one; 0 where all is well. */
static int refused(char *text, size_t length, const char *path, char *why) {
    size_t head = strlen(MAGIC), first = strcspn(text, "\r\n"), end;
    char sum[16];
    if (strncmp(text, MAGIC, head)) {
        snprintf(why, BOUNCE_LAW_WHY, "%s is no bounce law of lithobrake: its first line is '%.*s'", path,
                 (int)(first < 40 ? first : 40), text);
        return 1;
    }
    if (first - head != strlen(VERSION) || strncmp(text + head, VERSION, first - head)) {
        snprintf(why, BOUNCE_LAW_WHY, "%s has version %.*s, but this reader reads " VERSION ": take that of its export",
                 path, (int)(first - head < 20 ? first - head : 20), text + head);
        return 1;
    }
    end = length && text[length - 1] == '\n' ? length - 1 : length;
    for (length = end; length && text[length - 1] != '\n'; length--) {}
    snprintf(sum, sizeof sum, "end %08lx", (unsigned long)crc32_of(text, length));
    if (end - length != strlen(sum) || strncmp(text + length, sum, end - length)) {
        snprintf(why, BOUNCE_LAW_WHY, "%s was cut short or changed after it was written: export it again", path);
        return 1;
    }
    text[length] = '\0';
    return 0;
}

/* The next word, ended in its place; lines that begin with # are left out. */
static char *next_word(char **at) {
    char *word = *at;
    for (;;) {
        word += strspn(word, " \n");
        if (*word != '#') break;
        word += strcspn(word, "\n");
    }
    if (!*word) return NULL;
    *at = word + strcspn(word, " \n");
    if (**at) *(*at)++ = '\0';
    return word;
}

static int read_block(block *one, const char *kind, char **at) {
    int is_names = !strcmp(kind, "names"), rank = 1;
    /* No block has more words than what is left has letters. */
    size_t most = strlen(*at);
    char *word = next_word(at);
    if (!word || (!is_names && strcmp(kind, "numbers"))) return 0;
    one->name = word;
    if (!is_names) rank = (word = next_word(at)) ? atoi(word) : 0;
    if (rank < 1 || rank > MOST_SIZES) return 0;
    one->count = 1;
    for (int k = 0; k < rank; k++) {
        if (!(word = next_word(at))) return 0;
        one->size[k] = (size_t)strtoul(word, NULL, 10);
        if (one->size[k] > most || (one->count *= one->size[k]) > most) return 0;
    }
    if (is_names) one->words = calloc(one->count + 1, sizeof *one->words);
    else one->numbers = calloc(one->count + 1, sizeof *one->numbers);
    if (!one->words && !one->numbers) return 0;
    for (size_t k = 0; k < one->count; k++) {
        char *end = NULL;
        if (!(word = next_word(at))) return 0;
        if (is_names) one->words[k] = word;
        else one->numbers[k] = strtod(word, &end);
        /* A locale with a decimal comma reads no point. */
        if (end && *end) return 0;
    }
    return 1;
}

/* A block by its name; a missing one marks the law as damaged. */
static const block *found(const bounce_law *law, const char *name, int *damaged) {
    static const block none;
    for (int k = 0; k < law->block_count; k++)
        if (!strcmp(law->blocks[k].name, name)) return &law->blocks[k];
    *damaged = 1;
    return &none;
}

static const double *numbers(const bounce_law *law, const char *name, size_t count, int *damaged) {
    const block *one = found(law, name, damaged);
    if (!one->numbers || one->count != count) *damaged = 1;
    return one->numbers;
}

/* Whether numbers that count something are from least up to, not including, end. */
static int all_within(const double *numbers, size_t count, double least, size_t end) {
    for (size_t k = 0; k < count; k++)
        if (!(numbers[k] >= least && numbers[k] < (double)end)) return 0;
    return 1;
}

/* Whether numbers that count something fit the sizes of the others. */
static int counts_fit(const bounce_law *law) {
    size_t of_attitude = law->kind[1] != 0 ? 3 : law->kind[0] != 0 ? 6 + 2 * law->axes : 3 * law->axes;
    if (law->axes && law->kind[0] != 0 && law->kind[1] == 0 && law->axes < 2) return 0;
    return law->inputs - law->plain == (law->axes ? of_attitude : 0)
        && all_within(law->indices, law->terms * law->inputs, 0, law->degree + 1)
        && all_within(law->soil_place, law->soil_places, 0, law->conditions)
        && all_within(law->bound_places, 5, -1, law->conditions) && all_within(law->outcome_places, 1, 0, law->outcomes)
        && all_within(law->outcome_places + 1, 1, -1, law->outcomes)
        && (law->outcome_places[1] < 0 || law->resting) && law->rows && law->soils;
}

static int bind(bounce_law *law) {
    int damaged = 0;
    const block *location = found(law, "location", &damaged), *indices = found(law, "multi_indices", &damaged);
    const block *outcomes = found(law, "outcomes", &damaged), *conditions = found(law, "conditions", &damaged);
    const block *units = found(law, "units", &damaged), *soils = found(law, "soils", &damaged);
    size_t f = law->fits = location->size[0], t = law->terms = indices->size[0], i = law->inputs = indices->size[1];
    size_t k = law->outcomes = outcomes->count, c = law->conditions = conditions->count, r;
    law->condition = conditions->words, law->unit = units->words, law->outcome = outcomes->words;
    if (!law->condition || !law->unit || !law->outcome || units->count != c || !i || t < i || !f) return 0;
    r = law->rows = found(law, "row_inputs", &damaged)->size[0];
    law->degree = found(law, "center", &damaged)->size[1];
    law->axes = found(law, "attitude_axes", &damaged)->size[0];
    law->plain = i - found(law, "attitude_ranges", &damaged)->size[0];
    law->resting = found(law, "rest_rows", &damaged)->size[0];
    law->soils = soils->size[0], law->soil_places = soils->size[1];
    if (law->plain > c || law->plain > i) return 0;
#define GET(field, name, count) law->field = numbers(law, name, count, &damaged)
    GET(lower, "lower", c), GET(upper, "upper", c), GET(is_log, "is_log", i), GET(zero, "germ_zero", i);
    GET(slope, "germ_slope", i), GET(center, "center", i * law->degree), GET(spread, "spread", i * law->degree);
    GET(indices, "multi_indices", t * i), GET(widths, "kernel_widths", i), GET(row_inputs, "row_inputs", r * i);
    GET(distant, "distant", OUTPUTS), GET(location, "location", f * (t + 1) * OUTPUTS);
    GET(log_scale, "log_scale", f * (t + 1) * OUTPUTS), GET(limits, "scale_limits", f * 2 * OUTPUTS);
    GET(residuals, "rows", f * r * OUTPUTS), GET(weights, "row_weights", f * r), GET(smoothing, "smoothing_size", f);
    GET(root, "smoothing_root", f * OUTPUTS * OUTPUTS), GET(intercepts, "class_intercepts", f * k);
    GET(slopes, "class_slopes", f * k * t), GET(never, "class_never", f * k);
    GET(output_lower, "output_lower", OUTPUTS), GET(output_upper, "output_upper", OUTPUTS);
    GET(outcome_places, "outcome_places", 2), GET(left, "leaving_rows", r * 12);
    GET(rested, "rest_rows", law->resting * 8), GET(axis, "attitude_axes", law->axes * 3);
    GET(kind, "attitude_kind", 2), GET(ranges, "attitude_ranges", (i - law->plain) * 2), GET(bound, "bound", 8);
    GET(bound_places, "bound_places", 5), GET(bound_medians, "bound_medians", 5);
    GET(soil, "soils", law->soils * law->soil_places), GET(soil_place, "soil_places", law->soil_places);
#undef GET
    return !damaged && counts_fit(law);
}

bounce_law *bounce_law_open(const char *path, char why[BOUNCE_LAW_WHY]) {
    size_t length = 0;
    bounce_law *law = calloc(1, sizeof *law);
    char *at, *kind;
    if (!law || !(law->text = whole_file(path, &length))) {
        snprintf(why, BOUNCE_LAW_WHY, "%s cannot be read", path);
        free(law);
        return NULL;
    }
    if (refused(law->text, length, path, why)) {
        bounce_law_close(law);
        return NULL;
    }
    at = law->text + strcspn(law->text, "\n");
    while ((kind = next_word(&at)))
        if (law->block_count == MOST_BLOCKS || !read_block(&law->blocks[law->block_count++], kind, &at)) break;
    if (kind || !bind(law)) {
        snprintf(why, BOUNCE_LAW_WHY, "%s is damaged, memory is short, or the locale writes no decimal point", path);
        bounce_law_close(law);
        return NULL;
    }
    return law;
}

void bounce_law_close(bounce_law *law) {
    if (!law) return;
    for (int k = 0; k < law->block_count; k++) {
        free(law->blocks[k].words);
        free(law->blocks[k].numbers);
    }
    free(law->text);
    free(law);
}

static int is_within(int place, size_t count) { return place >= 0 && (size_t)place < count; }
int bounce_law_condition_count(const bounce_law *law) { return (int)law->conditions; }
int bounce_law_fit_count(const bounce_law *law) { return (int)law->fits; }
const char *bounce_law_condition(const bounce_law *law, int place) {
    return is_within(place, law->conditions) ? law->condition[place] : NULL;
}
const char *bounce_law_unit(const bounce_law *law, int place) {
    return is_within(place, law->conditions) ? law->unit[place] : NULL;
}
const char *bounce_law_outcome(const bounce_law *law, int outcome) {
    return is_within(outcome, law->outcomes) ? law->outcome[outcome] : NULL;
}
double bounce_law_lower(const bounce_law *law, int place) {
    return is_within(place, law->conditions) ? law->lower[place] : NAN;
}
double bounce_law_upper(const bounce_law *law, int place) {
    return is_within(place, law->conditions) ? law->upper[place] : NAN;
}
int bounce_law_place(const bounce_law *law, const char *condition) {
    for (size_t k = 0; k < law->conditions; k++)
        if (!strcmp(law->condition[k], condition)) return (int)k;
    return -1;
}

/* ---- drawing ---- */

void bounce_law_soil(const bounce_law *law, uint64_t seed, uint64_t journey, double *conditions) {
    size_t row = (size_t)(uniform(seed, journey, SOIL) * (double)law->soils);
    for (size_t k = 0; k < law->soil_places; k++)
        conditions[(size_t)law->soil_place[k]] = law->soil[row * law->soil_places + k];
}

static double squared(const double *vector, int count) {
    double sum = 0;
    for (int k = 0; k < count; k++) sum += vector[k] * vector[k];
    return sum;
}

static double clipped(double value, double lower, double upper) {
    return value < lower ? lower : value > upper ? upper : value;
}

/* Terms of the attitude: how the ground's normal n and the direction of travel t lie as seen from the lander. */
static void attitude_terms(const bounce_law *law, const double q[4], double *terms) {
    double length = sqrt(squared(q, 4));
    double w = q[0] / length, x = q[1] / length, y = q[2] / length, z = q[3] / length;
    double normal[3] = {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)};
    double travel[3] = {1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)};
    double sums[3] = {0, 0, 0};
    size_t count = law->inputs - law->plain, at = 0;
    int has_sides = law->kind[0] != 0, is_cube = law->kind[1] != 0;
    for (size_t k = 0; k < law->axes; k++) {
        const double *axis = law->axis + 3 * k;
        double n = 0, t = 0, b = 0;
        for (int j = 0; j < 3; j++) {
            int one = (j + 1) % 3, other = (j + 2) % 3;
            n += axis[j] * normal[j];
            t += axis[j] * travel[j];
            b += axis[j] * (normal[one] * travel[other] - normal[other] * travel[one]);
        }
        if (is_cube) {
            sums[0] += n * n * n * n;
            sums[1] += n * n * n * t;
            sums[2] += n * n * (t * t - b * b);
            continue;
        }
        if (has_sides) terms[6 + k] = n, terms[6 + law->axes + k] = t;
        if (has_sides && k >= 2) continue;
        terms[at++] = n * n;
        terms[at++] = 2 * n * t;
        terms[at++] = t * t - b * b;
    }
    if (is_cube) memcpy(terms, sums, sizeof sums);
    for (size_t k = 0; k < count; k++) terms[k] = clipped(terms[k], law->ranges[2 * k], law->ranges[2 * k + 1]);
}

/* Products of orthonormal polynomials of the inputs [terms]; the first are the standardised inputs.
   table: [inputs][degree + 1], to work in. */
static void terms_at(const bounce_law *law, const double *inputs, double *table, double *terms) {
    size_t width = law->degree + 1;
    for (size_t i = 0; i < law->inputs; i++) {
        double germ = ((law->is_log[i] > 0 ? log(inputs[i]) : inputs[i]) - law->zero[i]) * law->slope[i];
        const double *center = law->center + i * law->degree, *spread = law->spread + i * law->degree;
        double *own = table + i * width;
        own[0] = 1;
        for (size_t k = 0; k < law->degree; k++)
            own[k + 1] = ((germ - center[k]) * own[k] - (k ? spread[k - 1] * own[k - 1] : 0)) / spread[k];
    }
    for (size_t t = 0; t < law->terms; t++) {
        terms[t] = 1;
        for (size_t i = 0; i < law->inputs; i++)
            terms[t] *= table[i * width + (size_t)law->indices[t * law->inputs + i]];
    }
}

/* Place of a random number among chances that need not sum to 1; they are accumulated in their place. */
static size_t place_of(double *chances, size_t count, double random) {
    size_t place = 0;
    for (size_t k = 1; k < count; k++) chances[k] += chances[k - 1];
    while (place < count - 1 && chances[place] / chances[count - 1] <= random) place++;
    return place;
}

static size_t drawn_outcome(const bounce_law *law, const double *terms, size_t fit, double *chances, double random) {
    const double *never = law->never + fit * law->outcomes;
    double most = -INFINITY, total = 0, unmet = 0;
    for (size_t k = 0; k < law->outcomes; k++) {
        const double *slopes = law->slopes + (fit * law->outcomes + k) * law->terms;
        chances[k] = law->intercepts[fit * law->outcomes + k];
        for (size_t t = 0; t < law->terms; t++) chances[k] += terms[t] * slopes[t];
        if (never[k] > 0) chances[k] = -INFINITY;
        if (chances[k] > most) most = chances[k];
        unmet += never[k];
    }
    for (size_t k = 0; k < law->outcomes; k++) total += chances[k] = exp(chances[k] - most);
    for (size_t k = 0; k < law->outcomes; k++) chances[k] = never[k] + (1 - unmet) * chances[k] / total;
    return place_of(chances, law->outcomes, random);
}

/* The landing that gives scatter and direction: one whose inputs are near, where the law looks at that. */
static size_t drawn_row(const bounce_law *law, const double *terms, size_t fit, double *chances, double random) {
    double least = INFINITY;
    for (size_t row = 0; row < law->rows; row++) {
        chances[row] = 0;
        for (size_t i = 0; i < law->inputs; i++)
            if (isfinite(law->widths[i])) {
                double apart = (terms[i] - law->row_inputs[row * law->inputs + i]) / law->widths[i];
                chances[row] += apart * apart;
            }
        if (chances[row] < least) least = chances[row];
    }
    for (size_t row = 0; row < law->rows; row++)
        chances[row] = law->weights[fit * law->rows + row] * exp(-0.5 * (chances[row] - least));
    return place_of(chances, law->rows, random);
}

static double ratio(double value, double median) { return median != 0 ? value / median : 1; }

/* Speed [m/s] that energy allows, and smallest radius of gyration [m]. */
static double most_speed(const bounce_law *law, const double *x, const double *spin, double *gyration) {
    const double *bound = law->bound;
    double known[5], power, rate, gravity, slope, fallen;
    for (int k = 0; k < 5; k++)
        known[k] = law->bound_places[k] < 0 ? law->bound_medians[k] : x[(size_t)law->bound_places[k]];
    power = pow(ratio(known[3], law->bound_medians[3]), bound[5]) * pow(ratio(known[4], law->bound_medians[4]), bound[6]);
    rate = spin ? sqrt(squared(spin, 3)) : bound[7];
    gravity = fabs(known[2]), slope = sin(known[1] * PI / 180);
    fallen = bound[1] + known[0] * bound[2] + 0.5 * gravity * slope * bound[2] * bound[2];
    *gyration = sqrt(bound[3] * power);
    return sqrt(known[0] * known[0] + bound[4] * power * rate * rate + 2 * gravity * (bound[0] + fallen * slope));
}

/* An output of its coordinate: a logit between two bounds, a logarithm beyond one, itself where they are distant. */
static double from_coordinate(double coordinate, double lower, double upper, int is_distant) {
    double y = coordinate, limited = clipped(coordinate, -700, 700);
    int has_lower = isfinite(lower), has_upper = isfinite(upper);
    if (!is_distant && has_lower && has_upper) y = lower + (upper - lower) / (1 + exp(-limited));
    else if (!is_distant && has_lower) y = lower + exp(limited);
    else if (!is_distant && has_upper) y = upper - exp(-limited);
    return clipped(y, nextafter(lower, INFINITY), nextafter(upper, -INFINITY));
}

/* Speed, elevation and rate of spin: location and scale at the inputs, smoothed residuals of a row. */
static void outputs_of(const bounce_law *law, const double *terms, size_t row, size_t fit, const double *random,
                       const double *x, const double *spin, double y[OUTPUTS]) {
    double one = sqrt(-2 * log(random[0])), other = sqrt(-2 * log(random[2])), gyration = 0;
    double normal[3] = {one * cos(2 * PI * random[1]), one * sin(2 * PI * random[1]), other * cos(2 * PI * random[3])};
    double upper[OUTPUTS], size = law->smoothing[fit];
    memcpy(upper, law->output_upper, sizeof upper);
    if (isfinite(upper[SPEED])) {
        upper[SPEED] = most_speed(law, x, spin, &gyration);
        upper[RATE] = upper[SPEED] / gyration;
    }
    for (size_t k = 0; k < OUTPUTS; k++) {
        const double *location = law->location + fit * (law->terms + 1) * OUTPUTS + k;
        const double *log_scale = law->log_scale + fit * (law->terms + 1) * OUTPUTS + k;
        const double *limits = law->limits + fit * 2 * OUTPUTS + k;
        const double *root = law->root + (fit * OUTPUTS + k) * OUTPUTS;
        double where = location[0], scale = log_scale[0], noise = 0, scatter;
        for (size_t t = 0; t < law->terms; t++) {
            where += terms[t] * location[(t + 1) * OUTPUTS];
            scale += terms[t] * log_scale[(t + 1) * OUTPUTS];
        }
        for (size_t j = 0; j < OUTPUTS; j++) noise += root[j] * normal[j];
        scatter = (law->residuals[(fit * law->rows + row) * OUTPUTS + k] + size * noise) / sqrt(1 + size * size);
        y[k] = from_coordinate(where + exp(clipped(scale, limits[0], limits[OUTPUTS])) * scatter, law->output_lower[k],
                               upper[k], law->distant[k] != 0);
    }
    /* What the speed has taken of the energy is not there for the spin. */
    if (gyration > 0) {
        double left = upper[SPEED] * upper[SPEED] - y[SPEED] * y[SPEED];
        y[RATE] = fmin(y[RATE], sqrt(fmax(left, 0)) / gyration);
    }
}

static void fill(bounce_law_rebound *rebound, const double *told) {
    rebound->duration = told[0];
    memcpy(rebound->way, told + 1, 3 * sizeof(double));
    memcpy(rebound->attitude, told + 4, 4 * sizeof(double));
}

static int checked(const bounce_law *law, const double *x, const double *attitude, const double *spin, int fit,
                   char *why) {
    double square = 1;
    if (fit < 0 || (size_t)fit >= law->fits) {
        snprintf(why, BOUNCE_LAW_WHY, "fit is %d; allowed: 0 to %d", fit, (int)law->fits - 1);
        return BOUNCE_LAW_WRONG;
    }
    if (attitude) square = squared(attitude, 4);
    if (!(square > 0 && isfinite(square))) {
        snprintf(why, BOUNCE_LAW_WHY, "attitude is (%g, %g, %g, %g); allowed: a quaternion w, x, y, z that is not 0",
                 attitude[0], attitude[1], attitude[2], attitude[3]);
        return BOUNCE_LAW_WRONG;
    }
    if (spin && !isfinite(squared(spin, 3))) {
        snprintf(why, BOUNCE_LAW_WHY, "spin is (%g, %g, %g); allowed: finite numbers", spin[0], spin[1], spin[2]);
        return BOUNCE_LAW_WRONG;
    }
    for (size_t k = 0; k < law->conditions; k++)
        if (!(x[k] >= law->lower[k] && x[k] <= law->upper[k] && isfinite(x[k]))) {
            const char *unit = strcmp(law->unit[k], "-") ? law->unit[k] : "";
            snprintf(why, BOUNCE_LAW_WHY, "%s is %g%s%s, but the law holds from %g to %g", law->condition[k], x[k],
                     *unit ? " " : "", unit, law->lower[k], law->upper[k]);
            return BOUNCE_LAW_OUTSIDE;
        }
    return BOUNCE_LAW_OK;
}

/* A quaternion, even over all rotations, of three uniform numbers, by the method of Shoemake. */
static void any_attitude(const double *random, double attitude[4]) {
    double near = sqrt(1 - random[0]), far = sqrt(random[0]);
    double first = 2 * PI * random[1], second = 2 * PI * random[2];
    attitude[0] = far * cos(second), attitude[1] = near * sin(first);
    attitude[2] = near * cos(first), attitude[3] = far * sin(second);
}

static void leave(const bounce_law *law, size_t row, const double y[OUTPUTS], bounce_law_rebound *rebound) {
    const double *left = law->left + 12 * row;
    double level = y[SPEED] * cos(y[ELEVATION]);
    rebound->row = (int)row;
    rebound->velocity[0] = level * cos(left[0]);
    rebound->velocity[1] = level * sin(left[0]);
    rebound->velocity[2] = y[SPEED] * sin(y[ELEVATION]);
    for (int k = 0; k < 3; k++) rebound->spin[k] = y[RATE] * left[1 + k];
    fill(rebound, left + 4);
}

int bounce_law_draw(const bounce_law *law, const double *conditions, const double attitude[4], const double spin[3],
                    int fit, uint64_t seed, uint64_t draw, bounce_law_rebound *rebound, char why[BOUNCE_LAW_WHY]) {
    static const double unknown[8] = {NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN};
    size_t longest = law->rows > law->outcomes ? law->rows : law->outcomes, outcome, row, of = (size_t)fit;
    double random[SOIL], any[4], y[OUTPUTS], *inputs, *terms, *chances;
    int status = checked(law, conditions, attitude, spin, fit, why);
    if (status) return status;
    for (size_t k = 0; k < SOIL; k++) random[k] = uniform(seed, draw, k);
    inputs = malloc((law->inputs * (law->degree + 2) + law->terms + longest) * sizeof *inputs);
    if (!inputs) {
        snprintf(why, BOUNCE_LAW_WHY, "memory is short");
        return BOUNCE_LAW_WRONG;
    }
    terms = inputs + law->inputs, chances = terms + law->terms;
    memcpy(inputs, conditions, law->plain * sizeof *inputs);
    if (!attitude) any_attitude(random + ATTITUDE, any);
    if (law->inputs > law->plain) attitude_terms(law, attitude ? attitude : any, inputs + law->plain);
    terms_at(law, inputs, chances + longest, terms);
    outcome = drawn_outcome(law, terms, of, chances, random[OUTCOME]);
    memset(rebound, 0, sizeof *rebound);
    rebound->outcome = (int)outcome, rebound->row = -1;
    rebound->leaves = (double)outcome == law->outcome_places[0];
    rebound->captured = (double)outcome == law->outcome_places[1];
    if (rebound->captured) {
        fill(rebound, law->rested + 8 * (size_t)(random[REST] * (double)law->resting));
    } else if (rebound->leaves) {
        row = drawn_row(law, terms, of, chances, random[ROW]);
        outputs_of(law, terms, row, of, random + NOISE, conditions, spin, y);
        leave(law, row, y, rebound);
    } else {
        for (int k = 0; k < 3; k++) rebound->velocity[k] = rebound->spin[k] = NAN;
        fill(rebound, unknown);
    }
    free(inputs);
    return BOUNCE_LAW_OK;
}
