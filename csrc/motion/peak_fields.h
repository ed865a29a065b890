/* The table of all peaks: what is kept between records, over each record's interval and over the whole run.
 *
 * TRB_PEAK_QUANTITIES(X): X(name, field, sense), what is evaluated at the end of every step, and the field of records that has as many
 * values; the loads, which have means, come first.
 * TRB_PEAK_FIELDS(X): X(name, quantity, take, unit, text), what is written of it. Texts hold for an interval and for a run. */
#ifndef TRB_MOTION_PEAK_FIELDS_H
#define TRB_MOTION_PEAK_FIELDS_H

#include "motion/fields.h"

typedef enum trb_peak_sense { TRB_PEAK_MOST, TRB_PEAK_LEAST } trb_peak_sense; /* the largest value, or the smallest */

/* How two neighbouring intervals are joined follows from it. */
typedef enum trb_peak_take {
  TRB_TAKE_EXTREME, /* the largest or smallest value */
  TRB_TAKE_TIME,    /* when it was reached, s */
  TRB_TAKE_MEAN,    /* time integral over the interval's length */
  TRB_TAKE_IMPACTS, /* contacts that began */
  TRB_TAKE_HARDEST, /* largest impulse of one contact */
  TRB_TAKE_IMPULSE  /* time integral */
} trb_peak_take;

/* Of each contact of the rollers with a ring (motion/fields.h). The smallest value is wanted of films, which are there in scenes with films
 * and under a load only. Peaks are taken of a model without friction and rolling resistance: a quantity of these would be zero. */
#define TRB_PEAK_OF_LOAD(X, kind, as, group, of, at) X(as##_load, as##_load, MOST)
#define TRB_PEAK_OF_PRESSURE(X, kind, as, group, of, at) X(as##_pressure, as##_pressure, MOST)
#define TRB_PEAK_OF_FILM(X, kind, as, group, of, at) X(as##_film_parameter, as##_film_parameter, LEAST)

#define TRB_PEAK_LOADS(X) \
  X(pocket_force,     pocket_force,       MOST) \
  TRB_SHOWN_CONTACTS(TRB_PEAK_OF_LOAD, X)
#define TRB_PEAK_QUANTITIES(X) \
  TRB_PEAK_LOADS(X) \
  TRB_SHOWN_CONTACTS(TRB_PEAK_OF_PRESSURE, X) \
  TRB_SHOWN_CONTACTS(TRB_PEAK_OF_FILM, X) \
  X(skew,             roller_skew,        MOST) \
  X(spacing_largest,  roller_orbit_angle, MOST) \
  X(spacing_smallest, roller_orbit_angle, LEAST) \
  X(land_force,       land_force,         MOST) \
  X(land_gap,         land_gap,           LEAST)

#define TRB_PEAK_FIELDS_OF_CONTACT(X, kind, as, group, of, at) \
  X(as##_load_peak,               as##_load,           EXTREME, "N",  "largest normal load at " at) \
  X(as##_load_peak_time,          as##_load,           TIME,    "s",  "time of " #as "_load_peak") \
  X(as##_load_mean,               as##_load,           MEAN,    "N",  "mean normal load at " at) \
  X(as##_pressure_peak,           as##_pressure,       EXTREME, "Pa", "largest Hertz pressure at " at) \
  X(as##_pressure_peak_time,      as##_pressure,       TIME,    "s",  "time of " #as "_pressure_peak") \
  X(as##_film_parameter_min,      as##_film_parameter, EXTREME, "1",  "smallest film parameter Lambda at " at " (of a raceway: mean over the contact, weighted by load); not a number: no film carried a load") \
  X(as##_film_parameter_min_time, as##_film_parameter, TIME,    "s",  "time of " #as "_film_parameter_min")

#define TRB_PEAK_FIELDS(X) \
  X(pocket_force_peak,      pocket_force,     EXTREME, "N",   "largest normal force between roller and each face of its pocket") \
  X(pocket_force_peak_time, pocket_force,     TIME,    "s",   "time of pocket_force_peak") \
  X(pocket_force_mean,      pocket_force,     MEAN,    "N",   "mean normal force between roller and each face of its pocket") \
  X(pocket_impacts,         pocket_force,     IMPACTS, "1",   "number of contacts between roller and each face of its pocket that began") \
  X(pocket_impulse,         pocket_force,     IMPULSE, "N s", "impulse of all contacts between roller and each face of its pocket") \
  X(pocket_impulse_peak,    pocket_force,     HARDEST, "N s", "largest impulse of one contact between roller and each face of its pocket, from where it began") \
  TRB_SHOWN_CONTACTS(TRB_PEAK_FIELDS_OF_CONTACT, X) \
  X(skew_peak,              skew,             EXTREME, "rad", "largest skew, either way") \
  X(skew_peak_time,         skew,             TIME,    "s",   "time of skew_peak") \
  X(spacing_max,            spacing_largest,  EXTREME, "rad", "largest angle from each roller to the next one") \
  X(spacing_max_time,       spacing_largest,  TIME,    "s",   "time of spacing_max") \
  X(spacing_min,            spacing_smallest, EXTREME, "rad", "smallest angle from each roller to the next one") \
  X(spacing_min_time,       spacing_smallest, TIME,    "s",   "time of spacing_min") \
  X(land_force_peak,        land_force,       EXTREME, "N",   "largest normal force of the land on the cage; 0 without a land") \
  X(land_force_peak_time,   land_force,       TIME,    "s",   "time of land_force_peak") \
  X(land_gap_min,           land_gap,         EXTREME, "m",   "smallest gap between cage and land; 0 without a land") \
  X(land_gap_min_time,      land_gap,         TIME,    "s",   "time of land_gap_min")

#endif
