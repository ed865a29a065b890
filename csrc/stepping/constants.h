/* The numbers by which the stepping was set, each with its reason; docs/theory/numerics.md and docs/theory/multirate.md have what was measured.
 * Options of users are in stepping/integrator.h, and sizes of arrays, which follow from what they hold, stand with the arrays. */
#ifndef TRB_STEPPING_CONSTANTS_H
#define TRB_STEPPING_CONSTANTS_H

#include "body/body.h"

/* Differences and tolerances */

/* A step of a difference, by kind of entry, is small beside the scale on which the laws curve, micrometres of interference and a slip of 1e-4,
 * and large beside rounding. */
static const double trb_difference[TRB_N_TOLERANCES] = {1e-10, 1e-8, 1e-7, 1e-5, 1.0};
/* The frame R is turned by this angle for slopes over its turn, rad: rollers move by as large a part of the radius of their orbit, some tenths of a
 * micrometre in a bearing of the size of a hand, which is small beside what a load changes over and large beside rounding. */
static const double trb_turn_difference = 1e-5;
/* A turn of the frame R by this angle counts as one tolerance, rad, as positions and angles have tolerances of their own and the turn has none. */
static const double trb_turn_tolerance = 1e-3;
/* This absolute tolerance belongs to spin angles and quadratures, which no force reads, so that they never limit a step. */
static const double trb_tolerance_of_integrals = 1e30;
/* Absolute tolerances of velocities are at most this multiple of the relative tolerance times the mean rolling speed, as the slip of slow
 * rotation is a small share of a small speed. */
static const double trb_slow_share = 10.0;
/* This is added to a divisor so that an error of exactly zero divides nothing by zero; it changes no other quotient. */
static const double trb_above_zero = 1e-300;
/* The axis of a body is skewed by less than this angle, rad: the two angles of an axis are no coordinates any more at a right angle. */
static const double trb_most_skew = 1.5;
/* A time that no run reaches stands for an end that is not prescribed, s. */
static const double trb_never = 1e30;

/* Newton's method, with one step for all bodies and with steps of each */

/* A solve ends without a solution after this number of iterations, as a shorter step costs less than more of them. */
enum { TRB_NEWTON_ITERATIONS = 6 };
/* What the equations lack is accepted below this share of the tolerance whatever it was before, as a correction has nothing to show there. */
static const double trb_newton_negligible = 0.04;
/* Above that share it must have fallen to this part by a correction: a slope that is too large would leave nearly all of it in every step. */
static const double trb_newton_contraction = 0.3;
/* A correction may repeat at most this share of the last one before it is prolonged no further, which limits the prolongation to twenty times. */
static const double trb_broyden_most_kept = 0.95;
/* A solve is given up when a correction is this multiple of the first one, as it does not come back from there within its iterations. */
static const double trb_newton_divergence = 1e3;
/* Slopes are poor where a first correction leaves more than this share of what the equations lacked; right slopes leave nearly nothing. */
static const double trb_poor_share = 0.2;
/* A body has its slopes taken again if its part is more than this share of what is too much, so that the others together leave less than that. */
static const double trb_poor_body_share = 0.5;
/* Poor slopes of a body are taken again after this number of solves at least, so that a body whose slopes never do costs no differences in every step. */
enum { TRB_SOLVES_BETWEEN_RENEWALS = 20 };
/* The present solve has this weight in the share of solves that fail, so that about the last thirty of them count. */
static const double trb_newest_solve_weight = 0.03;
/* Above this share of failing solves all forces are exact and the equations must hold closely: friction is so steep there that what a step lacks
 * within the tolerance is a force that makes as much energy as the bearing loses. */
static const double trb_failing_sometimes = 0.1;
/* This share of the tolerance is what the equations may then lack. */
static const double trb_newton_close = 0.004;
/* Above this share of failing solves bodies are taken one by one; the few failures of an impact are well answered by a shorter step. */
static const double trb_failing_often = 0.3;
/* Slopes are then taken again at most this number of times within a solve, as each time costs a Jacobian. */
enum { TRB_MOST_RENEWALS = 8 };
/* Where that was in vain it is left out for one failed solve, then for twice as many each time, but for no more than this number, so that a scene
 * in which it helps later is not without it for long. */
enum { TRB_LONGEST_PAUSE = 64 };

/* The linear system */

/* Factors are found again after this number of steps at the latest, which is what CVODE does by itself. */
enum { TRB_SETUP_EVERY = 20 };
/* The Jacobian's part from pockets is evaluated again after this number of steps at the latest, as a contact changes within so many. */
enum { TRB_JACOBIAN_EVERY = 10 };
/* Factors serve for another gamma as long as it differs by no more than this share, which is what CVODE does by itself. */
static const double trb_gamma_change = 0.3;
/* The entry on the diagonal is the pivot if it is at least this share of the largest one: no multiplier is then larger than ten, and rows
 * are hardly ever exchanged. */
static const double trb_diagonal_share = 0.1;
/* A vector is looked through with this number of sums side by side, as one alone would wait for each of its additions. */
enum { TRB_SUMS_SIDE_BY_SIDE = 16 };
/* A cache line has this number of entries of 8 bytes; the borders of a roller begin with one. */
enum { TRB_CACHE_LINE = 8 };

/* One step for all bodies, by CVODE and ARKODE */

/* A step may be refused for its error this number of times: twice what CVODE allows by itself, as an impact shortens steps by powers of ten. */
enum { TRB_MOST_ERROR_FAILURES = 15 };
/* A step may go unsolved this number of times: more than twice what CVODE allows by itself, for the same reason. */
enum { TRB_MOST_SOLVE_FAILURES = 25 };
/* The explicit method has this order; it is there for cross-checks, and a high order shows errors of the other ones. */
enum { TRB_EXPLICIT_ORDER = 5 };

/* Steps of each body: the formula */

/* The formula of order 2 changes the rate and the curvature of a polynomial by these multiples of the correction of its value. */
static const double trb_course_l1 = 1.5, trb_course_l2 = 0.5;
/* One over the first of them is what the equations of a step have before the rate. */
static const double trb_course_per_l1 = 2.0 / 3.0;
/* A roller may be ahead of the hub by this number of steps, so that what is stored of it is bounded. */
enum { TRB_COURSE_LEAD = 8 };
/* This number of earlier steps is kept, so that a body can be asked for the time of another one's last step and be taken back to its end. */
enum { TRB_COURSE_KEPT = 2 * TRB_COURSE_LEAD + 2 };

/* Steps of each body: their length */

/* The first step has this length where none is given, s; it is below the shortest time in which forces change, and soon grows. */
static const double trb_first_step = 1e-9;
/* A step is tried this number of times, by which it has become shorter than any that may be taken. */
enum { TRB_MOST_TRIES = 60 };
/* After this number of errors that were too large, one after the other, a body begins again from its rates, as its polynomial then has no part in
 * the motion any more; CVODE does so, too. */
enum { TRB_ERRORS_UNTIL_RESTART = 3 };
/* A step may grow after this number of steps of one length, as fixed coefficients are stable only where lengths do not change all the time. */
enum { TRB_STEPS_UNTIL_LONGER = 3 };
/* A step grows only if this factor of its length is to be had, as each other length costs a factorisation; CVODE does so, too. */
static const double trb_least_growth = 1.5;
/* It grows by this factor at most, as an error that is small by chance promises too much; CVODE does so, too. */
static const double trb_most_growth = 10.0;
/* This is added to the inverse of a growth, so that a body at rest does not divide by zero. */
static const double trb_growth_offset = 1e-6;
/* The next step is meant for an error of one over this number, so that few steps are refused; CVODE does so, too. */
static const double trb_error_margin = 6.0;
/* A step that was not solved is shortened by this factor; CVODE does so, too. */
static const double trb_unsolved_cut = 0.25;
/* A step whose error was too large is shortened to this part of its length at least, as an error far beyond the tolerance says little. */
static const double trb_least_cut = 0.2;
/* It is shortened to this part at most, so that the next try differs. */
static const double trb_most_cut = 0.9;
/* Where less than this multiple of a step is left before an end that is prescribed, the rest is taken in two halves, so that no sliver is left. */
static const double trb_sliver = 1.5;
/* This is that half, and also what a step of the hub is cut to when rollers join it, as it was too long for what they do. */
static const double trb_half_step = 0.5;

/* Steps of each body: which rollers step with the hub, and what limits them */

/* A roller of the hub's team leaves it after this number of steps in which it has touched nothing, as it mostly comes back soon after a hit. */
enum { TRB_STEPS_UNTIL_LEAVES = 30 };
/* Skew, tilt and the spins that belong to them have this share of their error in a step of rollers that touch the hub, with steps of each body and
 * of several bearings. They swing fast there; with it
 * forces in pockets are as exact as with one step for all bodies, and below they are not (docs/theory/multirate.md#what-limits-a-step). */
static const double trb_swing_share = 0.5;

/* Impacts */

/* A gap is looked at for this number of steps ahead, as a step may grow before it closes. */
static const double trb_impact_steps_ahead = 3.0;
/* The spring on which two bodies are taken to meet is as stiff as the contact is at this interference, m, a usual one of a hit. */
static const double trb_impact_interference = 1e-6;

/* Tangents: where they hold */

/* A roller on a tangent may use up this share of a contact's margin, as what was learned in one direction says little about another. */
static const double trb_margin_share = 0.5;
/* It may slip away by this share of the mean rolling speed, within which boundary friction is linear. */
static const double trb_slip_share = 3e-3;
/* That share is meant for friction that turns from its slope to its limit over one part in this number of the rolling speed, the decay of the
 * boundary friction of the standard inputs; where a scene's law turns over less, the share is less. */
static const double trb_decay_of_slip_share = 181.46;
/* A tangent is used if its origins were good for this number of evaluations in the mean: each new origin puts a small step into the forces, which
 * costs more than it saves otherwise. */
static const double trb_least_mean_uses = 3.0;
/* It is also used if the present origin was good for this number of evaluations, so that it comes back where the motion has become smooth. */
static const double trb_least_uses = 9.0;
/* The last origin has this weight in that mean, so that about the last five count. */
static const double trb_newest_origin_weight = 0.2;
/* Slopes are computed again by differences after this number of corrections, which cost about as many exact evaluations: each correction is right
 * along its own step only. */
enum { TRB_MOST_CORRECTIONS = 20 };

/* Tangents: their reach */

/* A tangent of which nothing is known but its slopes reaches this far, in tolerances. */
static const double trb_first_reach = 1.0;
/* The reach stays above this, so that it can grow again. */
static const double trb_least_reach = 1e-3;
/* The reach stays below this, as the square of an error is not to be extrapolated further. */
static const double trb_largest_reach = 1e3;
/* The reach grows at most by this factor at once, as one small error may be chance. */
static const double trb_reach_growth = 3.0;
/* It falls at most to this part at once, as one large error may be a contact that has begun. */
static const double trb_reach_decline = 0.05;
/* It is this part of what would make the error as large as it may be, so that few predictions are worse. */
static const double trb_reach_caution = 0.8;
/* The same two numbers where the tangent bends are smaller, as a bend was seen between three origins and holds near these. */
static const double trb_bent_reach_growth = 1.2, trb_bent_reach_caution = 0.7;
/* Slopes are not corrected by a step longer than this, as the forces there belong to another motion. */
static const double trb_farthest_correction = 1e5;
/* The powers of a tangent may be wrong by this share of all power: in a stiff contact an error may hardly move the state and still change the work. */
static const double trb_power_share = 0.03;
/* Two steps between origins go one way if the cosine of the angle between them, in the metric of the tolerances, is above this: within 26 degrees. */
static const double trb_same_way_cosine = 0.9;
/* They go on evenly if neither is longer than the other by this factor, as an interpolation through three origins needs them apart. */
static const double trb_even_steps_ratio = 3.0;

/* The queue between the stepping and the thread of records and peaks */

/* The queue has this number of places: some milliseconds of work, which even out what the two threads need. */
enum { TRB_QUEUE_PLACES = 128 };
/* The second thread is woken when this number of places is filled, as to wake it costs as much as to compute a state. */
enum { TRB_QUEUE_ENOUGH = 32 };
/* The stepping goes on when this number of places is free, for the same reason. */
enum { TRB_QUEUE_FREE = 64 };

#endif
