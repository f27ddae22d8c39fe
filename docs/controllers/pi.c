/* A PI controller for CombBench, in C: cc -O2 -o pi pi.c
 *
 *     combbench run first-look --controller-process "./pi -2 -9"
 *
 * At each sample nine doubles come over standard input, little-endian, and one double goes back over standard output.
 * Numbers are not converted here, so the machine must be little-endian itself, as x86 and ARM are. */
#include <stdio.h>
#include <stdlib.h>

struct sample {
    double begins;    /* 1: begin anew, at the first sample, after a reset, at a cold start */
    double tick;      /* the number of the sample */
    double time_ms;   /* device time */
    double dt_ms;     /* time to the next sample */
    double reference; /* V */
    double model;     /* um, where the shuttle should be */
    double measured;  /* um */
    double applied;   /* V, over the sample that ends now */
    double engaged;   /* 1 while this controller drives */
};

int main(int count, char **arguments)
{
    const double kp = count > 1 ? atof(arguments[1]) : -2.0; /* V/um */
    const double ki = count > 2 ? atof(arguments[2]) : -9.0; /* V/(um ms) */
    double integral = 0.0;
    struct sample x;

    while (fread(&x, sizeof x, 1, stdin) == 1) { /* until the run ends and the pipe is closed */
        const double e = x.model - x.measured;
        double voltage;

        if (x.begins != 0.0)
            integral = 0.0;
        if (x.engaged == 0.0)
            integral = x.applied - kp * e; /* in shadow: ready to take over from here */
        else
            integral += ki * e * x.dt_ms;
        voltage = kp * e + integral;
        if (fwrite(&voltage, sizeof voltage, 1, stdout) != 1 || fflush(stdout) != 0)
            return 1;
    }
    return 0;
}
