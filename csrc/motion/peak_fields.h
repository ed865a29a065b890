/* The table of all peaks: what is kept between records, over each record's interval and over the whole run.
 *
 * TRB_PEAK_QUANTITIES(X): X(name, kind, sense), what is evaluated at the end of every step; the loads, which have means, come first.
 * TRB_PEAK_FIELDS(X): X(name, quantity, take, unit, text), what is written of it. Texts hold for an interval and for a run. */
#ifndef TRB_MOTION_PEAK_FIELDS_H
#define TRB_MOTION_PEAK_FIELDS_H

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

/* Of the rollers' contacts with the rings: F(X, pair, quantity, sense). <pair>_<quantity> is `quantity` of the look of that row of the table
 * of pairs (contact/pair.h); the smallest value is wanted of films, which are there in scenes with films and under a load only. Peaks are
 * taken of a model without friction and rolling resistance: a quantity of these would be zero. */
#define TRB_PEAK_CONTACTS(F, X) \
  F(X, outer,     load,            MOST) \
  F(X, inner,     load,            MOST) \
  F(X, rib,       load,            MOST) \
  F(X, front_rib, load,            MOST) \
  F(X, outer,     pressure,        MOST) \
  F(X, inner,     pressure,        MOST) \
  F(X, rib,       pressure,        MOST) \
  F(X, outer,     film_parameter,  LEAST) \
  F(X, inner,     film_parameter,  LEAST) \
  F(X, rib,       film_parameter,  LEAST)

#define TRB_PEAK_OF_CONTACT(X, pair, quantity, sense) X(pair##_##quantity, ROLLER, sense)

#define TRB_PEAK_QUANTITIES(X) \
  X(pocket_force,         POCKET_FACE, MOST) \
  TRB_PEAK_CONTACTS(TRB_PEAK_OF_CONTACT, X) \
  X(skew,                 ROLLER,      MOST) \
  X(spacing_largest,      ROLLER,      MOST) \
  X(spacing_smallest,     ROLLER,      LEAST) \
  X(land_force,           SCALAR,      MOST) \
  X(land_gap,             SCALAR,      LEAST)

#define TRB_PEAK_FIELDS(X) \
  X(pocket_force_peak,             pocket_force,         EXTREME, "N",   "largest normal force between roller and each face of its pocket") \
  X(pocket_force_peak_time,        pocket_force,         TIME,    "s",   "time of pocket_force_peak") \
  X(pocket_force_mean,             pocket_force,         MEAN,    "N",   "mean normal force between roller and each face of its pocket") \
  X(pocket_impacts,                pocket_force,         IMPACTS, "1",   "number of contacts between roller and each face of its pocket that began") \
  X(pocket_impulse,                pocket_force,         IMPULSE, "N s", "impulse of all contacts between roller and each face of its pocket") \
  X(pocket_impulse_peak,           pocket_force,         HARDEST, "N s", "largest impulse of one contact between roller and each face of its pocket, from where it began") \
  X(outer_load_peak,               outer_load,           EXTREME, "N",   "largest normal load, roller on outer raceway") \
  X(outer_load_peak_time,          outer_load,           TIME,    "s",   "time of outer_load_peak") \
  X(outer_load_mean,               outer_load,           MEAN,    "N",   "mean normal load, roller on outer raceway") \
  X(inner_load_peak,               inner_load,           EXTREME, "N",   "largest normal load, roller on inner raceway") \
  X(inner_load_peak_time,          inner_load,           TIME,    "s",   "time of inner_load_peak") \
  X(inner_load_mean,               inner_load,           MEAN,    "N",   "mean normal load, roller on inner raceway") \
  X(rib_load_peak,                 rib_load,             EXTREME, "N",   "largest normal load, large end on back-face rib") \
  X(rib_load_peak_time,            rib_load,             TIME,    "s",   "time of rib_load_peak") \
  X(rib_load_mean,                 rib_load,             MEAN,    "N",   "mean normal load, large end on back-face rib") \
  X(front_rib_load_peak,           front_rib_load,       EXTREME, "N",   "largest normal load, small end on front rib") \
  X(front_rib_load_peak_time,      front_rib_load,       TIME,    "s",   "time of front_rib_load_peak") \
  X(front_rib_load_mean,           front_rib_load,       MEAN,    "N",   "mean normal load, small end on front rib") \
  X(outer_pressure_peak,           outer_pressure,       EXTREME, "Pa",  "largest Hertz pressure at the outer raceway") \
  X(outer_pressure_peak_time,      outer_pressure,       TIME,    "s",   "time of outer_pressure_peak") \
  X(inner_pressure_peak,           inner_pressure,       EXTREME, "Pa",  "largest Hertz pressure at the inner raceway") \
  X(inner_pressure_peak_time,      inner_pressure,       TIME,    "s",   "time of inner_pressure_peak") \
  X(rib_pressure_peak,             rib_pressure,         EXTREME, "Pa",  "largest Hertz pressure at the rib") \
  X(rib_pressure_peak_time,        rib_pressure,         TIME,    "s",   "time of rib_pressure_peak") \
  X(outer_film_parameter_min,      outer_film_parameter, EXTREME, "1",   "smallest film parameter Lambda at the outer raceway (mean over the contact, weighted by load); not a number: no film carried a load") \
  X(outer_film_parameter_min_time, outer_film_parameter, TIME,    "s",   "time of outer_film_parameter_min") \
  X(inner_film_parameter_min,      inner_film_parameter, EXTREME, "1",   "smallest film parameter Lambda at the inner raceway (mean over the contact, weighted by load); not a number: no film carried a load") \
  X(inner_film_parameter_min_time, inner_film_parameter, TIME,    "s",   "time of inner_film_parameter_min") \
  X(rib_film_parameter_min,        rib_film_parameter,   EXTREME, "1",   "smallest film parameter Lambda at the rib; not a number: no film carried a load") \
  X(rib_film_parameter_min_time,   rib_film_parameter,   TIME,    "s",   "time of rib_film_parameter_min") \
  X(skew_peak,                     skew,                 EXTREME, "rad", "largest skew, either way") \
  X(skew_peak_time,                skew,                 TIME,    "s",   "time of skew_peak") \
  X(spacing_max,                   spacing_largest,      EXTREME, "rad", "largest angle from each roller to the next one") \
  X(spacing_max_time,              spacing_largest,      TIME,    "s",   "time of spacing_max") \
  X(spacing_min,                   spacing_smallest,     EXTREME, "rad", "smallest angle from each roller to the next one") \
  X(spacing_min_time,              spacing_smallest,     TIME,    "s",   "time of spacing_min") \
  X(land_force_peak,               land_force,           EXTREME, "N",   "largest normal force of the land on the cage; 0 without a land") \
  X(land_force_peak_time,          land_force,           TIME,    "s",   "time of land_force_peak") \
  X(land_gap_min,                  land_gap,             EXTREME, "m",   "smallest gap between cage and land; 0 without a land") \
  X(land_gap_min_time,             land_gap,             TIME,    "s",   "time of land_gap_min")

#endif
