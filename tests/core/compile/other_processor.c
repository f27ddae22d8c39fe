/* Runs boards whose steps are machine code of another compiler, and prints a hash of all signals and states now and
   then. A file has one board after another: whole numbers (rows, numbers of parameters, state, signals and places, first
   tick, ticks, ticks from one hash to the next), the interval, the table (step, offsets, interval), the arrays. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

typedef void step(double *, double *, double *, int64_t *);
#define STEP(number) extern step step_##number;
#include "steps.h"
#undef STEP
#define STEP(number) step_##number,
static step *const steps[] = {
#include "steps.h"
};

static void *read_numbers(int64_t count, FILE *file) {
    void *found = malloc(8 * count + 8);
    if (!found || fread(found, 8, count, file) != (size_t)count) exit(2);
    return found;
}

static uint64_t hash(uint64_t before, const double *numbers, int64_t count) {
    for (int64_t i = 0; i < count; i++) {
        union { double number; uint64_t bits; } one = {numbers[i]};
        if (numbers[i] != numbers[i]) one.bits = 0x7FF8000000000000u;
        before = (before ^ one.bits) * 0x100000001B3u;
        before ^= before >> 29;
    }
    return before;
}

int main(int count, char **words) {
    FILE *file = fopen(words[count - 1], "rb");
    int64_t head[8];
    while (file && fread(head, 8, 8, file) == 8) {
        double *interval = read_numbers(1, file);
        int64_t *table = read_numbers(5 * head[0], file);
        double *p = read_numbers(head[1], file), *s = read_numbers(head[2], file), *w = read_numbers(head[3], file);
        int64_t *io = read_numbers(head[4], file);
        for (int64_t done = 1; done <= head[6]; done++) {
            int64_t tick = head[5] + done - 1;
            w[0] = tick;
            w[1] = tick * *interval;
            for (int64_t row = 0; row < head[0]; row++) {
                int64_t *one = table + 5 * row;
                if (tick % one[4] == 0) steps[one[0]](p + one[1], s + one[2], w, io + one[3]);
            }
            if (done % head[7] == 0) printf("%016llx ", (unsigned long long)hash(hash(14695981039346656037u, w, head[3]), s, head[2]));
        }
        printf("\n");
    }
    return 0;
}
