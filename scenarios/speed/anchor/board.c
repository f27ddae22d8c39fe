/* A board in C: the loop over its ticks, the digest, the observer's comparisons and the history.
   The part before this text is written from the steps: `tick`, the counts of signals and the constants of the core. */

#define GROUPS_OF(count) (((count) + LANES - 1) / LANES)
#define OUTPUT_GROUPS GROUPS_OF(OUTPUTS)
#define GROUPS (OUTPUT_GROUPS + GROUPS_OF(TAPS))
#define ROW (GROUPS * LANES)
#define SLICE 64 /* ticks whose rows stay in the nearest memory: observed and kept before the next are run */
#define LEAST(a, b) ((a) < (b) ? (a) : (b))
#define MOST(a, b) ((a) > (b) ? (a) : (b))

struct board {
    double dt_ms, *p, *s, *w;
    int64_t *io;
    const uint8_t *on, *endless;
    uint64_t *folds;
    int64_t watched, room, found;
    const int64_t *columns;
    double *last;
    int64_t *changes;
    float *ring, *low, *high;
    int64_t *steady, places;
    const uint8_t *idle;
    const int64_t *offsets, *sizes;
};

static inline void fold(uint64_t *restrict folds, const double *restrict outputs)
{
    for (int c = 0; c < OUTPUTS; c++) {
        uint64_t x = (uint64_t)bits_of(outputs[c]);
        x = (x & UNSIGNED) > INFINITE_BITS ? NO_NUMBER : x;
        uint64_t a = (folds[c] ^ x) * FACTOR_A, b = (folds[OUTPUTS + c] + x) * FACTOR_B;
        folds[c] = a ^ (a >> SHIFT_A);
        folds[OUTPUTS + c] = b ^ (b >> SHIFT_B);
    }
}

/* Runs up to n ticks. Each row has the outputs, then the taps, each kind filled up to whole groups. */
static __attribute__((noinline)) int64_t run(
    int64_t n, int64_t first, double dt_ms, double *restrict p, double *restrict s, double *restrict w,
    int64_t *restrict io, const uint8_t *restrict on, double *restrict rows, uint64_t *restrict folds)
{
    for (int64_t i = 0; i < n; i++) {
        w[TICK] = (double)(first + i);
        w[TIME_MS] = (double)(first + i) * dt_ms;
        tick(first + i, p, s, w, io, on);
        if (rows) {
            memcpy(rows + i * ROW, w + RESERVED, 8 * OUTPUTS);
            memcpy(rows + i * ROW + OUTPUT_GROUPS * LANES, w + RESERVED + OUTPUTS, 8 * TAPS);
            fold(folds, w + RESERVED);
        }
        if (w[TRIP] != 0.0)
            return i + 1;
    }
    return n;
}

/* Writes down where a watched column differs from the row before. */
static void observe(struct board *b, const double *restrict rows, int64_t n, int64_t first)
{
    double *restrict last = b->last;
    for (int64_t i = 0; i < n; i++)
        for (int64_t k = 0; k < b->watched; k++) {
            double value = rows[i * ROW + b->columns[k]];
            if (value != last[k]) {
                if (b->found < b->room) {
                    b->changes[2 * b->found] = b->columns[k];
                    b->changes[2 * b->found + 1] = first + i;
                }
                b->found++;
                last[k] = value;
            }
        }
}

/* Keeps the ticks of a bucket of one group, with their minima and maxima while they are at hand. */
static inline void keep(const double *restrict rows, float *restrict ring, float *restrict low, float *restrict high)
{
    for (int c = 0; c < LANES; c++) {
#define TAKE(k) float x##k = (float)rows[k * ROW + c]; ring[k * LANES + c] = x##k;
        TAKE(0) TAKE(1) TAKE(2) TAKE(3) TAKE(4) TAKE(5) TAKE(6) TAKE(7)
        TAKE(8) TAKE(9) TAKE(10) TAKE(11) TAKE(12) TAKE(13) TAKE(14) TAKE(15)
        /* in halves, as the history does: of equal numbers, such as 0 and -0, it decides which is kept */
#define HALVES(of, to)                                                                                            \
    float a0 = of(x0, x8), a1 = of(x1, x9), a2 = of(x2, x10), a3 = of(x3, x11), a4 = of(x4, x12), a5 = of(x5, x13), \
          a6 = of(x6, x14), a7 = of(x7, x15), b0 = of(a0, a4), b1 = of(a1, a5), b2 = of(a2, a6), b3 = of(a3, a7),  \
          c0 = of(b0, b2), c1 = of(b1, b3);                                                                       \
    to[c] = of(c0, c1);
        { HALVES(LEAST, low) }
        { HALVES(MOST, high) }
    }
}

/* Folds a bucket into the bucket of the next level, which it begins or continues. */
static inline void widen(int begins, const float *low, const float *high, float *restrict lowest, float *restrict highest)
{
    for (int c = 0; c < LANES; c++) {
        lowest[c] = begins ? low[c] : LEAST(lowest[c], low[c]);
        highest[c] = begins ? high[c] : MOST(highest[c], high[c]);
    }
}

/* Appends whole buckets of 16 ticks to the history. */
static void append(struct board *b, const double *rows, int64_t n, int64_t first)
{
    int64_t levels = (b->offsets[2] + b->sizes[2]) * LANES;
    for (int64_t g = 0; g < GROUPS; g++) {
        if (b->idle[g] && b->steady[g] >= b->places)
            continue;
        b->steady[g] = b->idle[g] ? b->steady[g] + n : 0;
        float *ring = b->ring + g * b->places * LANES, *low = b->low + g * levels, *high = b->high + g * levels;
        for (int64_t i = 0; i < n; i += FACTOR) {
            int64_t bucket = (first + i) / FACTOR, at[3];
            for (int level = 0; level < 3; level++, bucket /= FACTOR)
                at[level] = (b->offsets[level] + bucket % b->sizes[level]) * LANES;
            bucket = (first + i) / FACTOR;
            keep(rows + i * ROW + g * LANES, ring + (first + i) % b->places * LANES, low + at[0], high + at[0]);
            widen(bucket % FACTOR == 0, low + at[0], high + at[0], low + at[1], high + at[1]);
            if (bucket % FACTOR == FACTOR - 1)
                widen(bucket / FACTOR % FACTOR == 0, low + at[1], high + at[1], low + at[2], high + at[2]);
        }
    }
}

static int is_lost(const struct board *b)
{
    int lost = 0;
    for (int64_t k = 0; k < STATES; k++)
        lost |= !(b->s[k] - b->s[k] == 0.0) & !b->endless[k];
    return lost;
}

/* The steps alone. */
int64_t steps(struct board *b, int64_t n, int64_t first)
{
    return run(n, first, b->dt_ms, b->p, b->s, b->w, b->io, b->on, 0, 0);
}

/* Ticks with their rows, the digest, the observer and a look for lost states; returns the ticks, or -1 for a loss. */
int64_t advance(struct board *b, int64_t n, int64_t first, double *rows)
{
    int64_t done = 0;
    while (done < n) {
        int64_t count = n - done < SLICE ? n - done : SLICE, at = first + done;
        int64_t ran = run(count, at, b->dt_ms, b->p, b->s, b->w, b->io, b->on, rows + done * ROW, b->folds);
        observe(b, rows + done * ROW, ran, at);
        done += ran;
        if (ran < count)
            break;
    }
    return is_lost(b) ? -1 : done;
}

/* The same as a live bench runs it, whole slices of ticks: the history instead of rows. */
int64_t live(struct board *b, int64_t n, int64_t first)
{
    static __attribute__((aligned(64))) double rows[SLICE * ROW];
    for (int64_t done = 0; done < n; done += SLICE) {
        int64_t at = first + done, ran = run(SLICE, at, b->dt_ms, b->p, b->s, b->w, b->io, b->on, rows, b->folds);
        observe(b, rows, ran, at);
        if (ran < SLICE)
            return done + ran;
        append(b, rows, SLICE, at);
    }
    return is_lost(b) ? -1 : n;
}

int64_t row(void) { return ROW; }
int64_t groups(void) { return OUTPUT_GROUPS; }
