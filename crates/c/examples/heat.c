/* A belt that warms its film, which makes it slide more easily: the thermal loop is closed here, outside of hersey.
 *
 *   cc heat.c -I ../include -L ../../../target/release -lhersey -o heat
 *
 * One body of a heat capacity is warmed by the friction of the contact and cooled by its surroundings. Over each step it
 * takes the heat that contact_energy has grown by: contact_power is its value at one moment, which stick-slip makes a
 * train of peaks.
 */
#include <stdio.h>

#include "hersey.h"

static const char *const belt =
    "format = 1\n"
    "drive = speed\n"
    "law = power\n"
    "closure = stiction\n"
    "temperature_law = power\n"
    "reference_temperature = 400\n"
    "force_temperature_exponent = -2\n"
    "speed_temperature_exponent = 3\n"
    "measured_temperatures = 350 401\n"
    "stiffness = 1000\n"
    "mass = 1\n"
    "transition_force = 50\n"
    "transition_speed = 1\n"
    "ehl_exponent = -0.7\n"
    "mixed_exponent = -1.2\n"
    "stick_speed = 0.01\n"
    "drive_speed = 2\n"
    "temperature = 400\n"
    "start = steady\n";

int main(void)
{
    const double capacity = 50.0, loss = 0.5, surroundings = 300.0, step = 0.01; /* J/K, W/K, K, s */
    double temperature = 400.0, before = 0.0, energy = 0.0;
    char why[200];
    int i, warnings = 0;
    hersey_drive *drive = hersey_drive_read(belt, why, sizeof why);
    if (drive == NULL) {
        fprintf(stderr, "%s\n", why);
        return 1;
    }
    if (hersey_begin(drive, 0.0) != HERSEY_DONE)
        return 1;
    for (i = 1; i <= 200; i++) {
        if (hersey_set(drive, "temperature", temperature) != HERSEY_DONE ||
            hersey_advance(drive, i * step, 0) != HERSEY_DONE ||
            hersey_get(drive, "contact_energy", &energy) != HERSEY_DONE) {
            fprintf(stderr, "%s\n", hersey_why(drive));
            return 1;
        }
        if (hersey_warning(drive)[0] != '\0')
            warnings++;
        temperature += (energy - before - step * loss * (temperature - surroundings)) / capacity;
        before = energy;
    }
    printf("temperature %.9g\nenergy %.9g\nwarnings %d\n", temperature, energy, warnings);
    hersey_free(drive);
    return 0;
}
