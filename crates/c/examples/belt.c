/* A belt that sticks and slips: its changes of mode over a second, and the same again from a state saved half-way.
 *
 *   cc belt.c -I ../include -L ../../../target/release -lhersey -o belt
 */
#include <stdio.h>
#include <stdlib.h>

#include "hersey.h"

static const char *const belt =
    "format = 1\n"
    "drive = speed\n"
    "law = power\n"
    "closure = retained\n"
    "temperature_law = none\n"
    "stiffness = 1000\n"
    "mass = 1\n"
    "transition_force = 50\n"
    "transition_speed = 1\n"
    "ehl_exponent = -0.7\n"
    "mixed_exponent = -1.2\n"
    "stick_speed = 0.01\n"
    "drive_speed = 1\n";

static double value(hersey_drive *drive, const char *name)
{
    double found;
    if (hersey_get(drive, name, &found) != HERSEY_DONE) {
        fprintf(stderr, "%s\n", hersey_why(drive));
        exit(1);
    }
    return found;
}

/* Follow the belt to a time, and print every change of mode. */
static void follow(hersey_drive *drive, double until)
{
    int outcome;
    while ((outcome = hersey_advance(drive, until, 1)) == HERSEY_CHANGED)
        printf("change %.17g %d\n", value(drive, "time"), (int)value(drive, "mode"));
    if (outcome == HERSEY_REFUSED) {
        fprintf(stderr, "%s\n", hersey_why(drive));
        exit(1);
    }
    printf("belt %.17g %.17g %.17g\n", value(drive, "time"), value(drive, "belt_speed"), value(drive, "spring_force"));
}

int main(void)
{
    char why[200];
    hersey_drive *drive = hersey_drive_read(belt, why, sizeof why);
    if (drive == NULL) {
        fprintf(stderr, "%s\n", why);
        return 1;
    }
    if (hersey_begin(drive, 0.0) != HERSEY_DONE)
        return 1;
    follow(drive, 0.5);

    size_t size = hersey_saved_size(drive);
    unsigned char *saved = malloc(size);
    if (saved == NULL || hersey_save(drive, saved, size) != HERSEY_DONE)
        return 1;
    follow(drive, 1.0);
    if (hersey_restore(drive, saved, size) != HERSEY_DONE)
        return 1;
    follow(drive, 1.0);

    free(saved);
    hersey_free(drive);
    return 0;
}
