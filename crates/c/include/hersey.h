/* hersey for C: the motion of a lubricated sliding drive, followed from call to call.
 *
 * Link with libhersey; crates/c/examples/belt.c is a whole program. The same library has the functions of FMI 3.0 and
 * 2.0 for co-simulation, which the headers of that standard declare; they take the same description of a drive, from
 * drive.txt among the resources of a unit.
 *
 * A description is text in UTF-8, in lines `name = value`; empty lines and those that begin with # are skipped. Numbers
 * are in SI, temperatures in K, those of a list stand on one line with blanks between. A line that is unknown, given
 * twice, or does not belong to the other choices is refused.
 *
 *   format = 1                  always
 *   drive = speed | torque      a speed at the far end of the spring, or a torque on the roll (then roll_radius)
 *   port = translational | rotational (translational)      of a speed: drive_speed in m/s; or the roll as a shaft, with
 *               roll_speed in rad/s, roll_radius, and the outputs reaction_torque and roll_angle
 *   law = power | table | mixed drag against speed:
 *       power   transition_force, transition_speed, ehl_exponent, mixed_exponent
 *       table   lists speeds and forces, ascending in speed
 *       mixed   viscosity, and the list numbers: reference, film exponent, load exponent, edge, roundness, stiffness
 *               of the asperities, boundary, shear, rolling, rolling exponent (crates/core/src/lubrication/mixed/sharing.rs)
 *   closure = retained | stiction | stribeck | lugre      below stick_speed
 *       lugre    bristle_stiffness, bristle_damping
 *       stiction static_growth and static_growth_time, if the static force grows at rest
 *   temperature_law = none | power | a law of viscosity                with all but none: reference_temperature
 *       power   force_temperature_exponent, speed_temperature_exponent; temperature_zero (0)
 *       the laws of viscosity by their words, each with what the list viscosity_numbers has; any other is refused:
 *               arrhenius (prefactor, activation_energy), vogel (prefactor, slope, zero), walther (a, b, density);
 *               boundary_temperature_slope (0) with law = mixed
 *       all     rest_temperature_slope (0)
 *   stiffness, mass, stick_speed                          always
 *   grip, static_force, rest_force (0), rest_damping (0)  if there are; grip with drive = speed
 *   drive_speed, roll_speed or drive_torque, and temperature          inputs at the start
 *   measured_speeds, measured_temperatures      if known: least and greatest belt speed, and temperature, at which the
 *               drag was measured; hersey_warning says when they are left
 *   start = rest | steady | given (rest)  given: start_belt_speed, start_stretch; steady with drive = speed
 *   tolerance (1e-9)            relative, of the steps
 *   most_steps (5000000)        that one call may take; one is about a microsecond
 *   token                       if given, what an FMI tool must know the unit by
 *
 * Drives are independent: each may be used by a thread of its own. A call on one that is at work in another is refused.
 * After what is refused the drive is as it was before. Same calls, same bits; where and how often a motion is stopped
 * changes none, unless an input has a slope, which begins anew at each stop (rounding, some 1e-15). What adds up since
 * the start (friction_energy, contact_energy, slip_energy, ways while the roll slips) is made by quadrature over the
 * stops, and agrees to some 1e-9 of the energy turned over.
 */
#ifndef HERSEY_H
#define HERSEY_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A drive: its description, its values, its motion. */
typedef struct hersey_drive hersey_drive;

/* What most functions return. */
enum {
    HERSEY_REFUSED = -1, /* hersey_why says why */
    HERSEY_DONE = 0,
    HERSEY_CHANGED = 1 /* hersey_advance: mode or slip has changed before the end */
};

/* Value of the variable `mode`. */
enum { HERSEY_EHL = 0, HERSEY_MIXED = 1, HERSEY_MICROSLIP = 2, HERSEY_STUCK = 3 };

/* Version of the library. */
const char *hersey_version(void);

/* The table of variables: a line each, of fields separated by tabs: value reference, name, type (Float64, Enumeration,
 * Boolean), causality, variability, unit, start (empty where the description has it), description, port (empty where a
 * drive has the variable with any), names of an enumeration (numbered from 0). A drive has the outputs of its port, the
 * inputs of its kind, and the parameters that its description gives or that have a start. */
const char *hersey_variables(void);

/* The drive that a text describes; null if it is none, with the reason in why (room bytes, the nul among them). */
hersey_drive *hersey_drive_read(const char *text, char *why, size_t room);

/* Give it back; null is let pass. */
void hersey_free(hersey_drive *drive);

/* Why the last call that was refused was so; holds until the next, so print it in a statement of its own. */
const char *hersey_why(hersey_drive *drive);

/* What the last hersey_begin or hersey_advance warned of, a line each: drive or temperature have left the range of
 * measured_speeds or measured_temperatures (once each time), or the belt is faster than that (once). Empty if it warned of nothing. */
const char *hersey_warning(hersey_drive *drive);

/* Set an input, at any time and from then on, or a parameter, before hersey_begin. */
int hersey_set(hersey_drive *drive, const char *name, double value);

/* Let an input change by so much per second during the next hersey_advance, up to its end; after HERSEY_CHANGED it goes
 * on to change. */
int hersey_slope(hersey_drive *drive, const char *name, double slope);

/* The value of a variable now; outputs after hersey_begin; of a Boolean 0 or 1. */
int hersey_get(hersey_drive *drive, const char *name, double *value);

/* Begin the motion at a time, s. */
int hersey_begin(hersey_drive *drive, double time);

/* On to a time, s, or to the first change of mode or slip before it if stop_at_changes is not 0. */
int hersey_advance(hersey_drive *drive, double until, int stop_at_changes);

/* All that changes, as bytes, from which a drive of the same description goes on to the last bit. */
size_t hersey_saved_size(hersey_drive *drive);
int hersey_save(hersey_drive *drive, unsigned char *bytes, size_t size);
int hersey_restore(hersey_drive *drive, const unsigned char *bytes, size_t size);

#ifdef __cplusplus
}
#endif

#endif
