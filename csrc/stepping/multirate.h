/* What the integrator of integrator_multirate.c steps with: bodies, each with its course, and teams of bodies that step together
 * (docs/theory/multirate.md). A team is the hub with the rollers that touch it, or one roller that touches nothing. */
#ifndef TRB_STEPPING_MULTIRATE_H
#define TRB_STEPPING_MULTIRATE_H

#include "stepping/course.h"
#include "stepping/integrator.h"
#include "stepping/jacobian.h"
#include "stepping/newton_rules.h"

/* A body, with what Newton's method needs of it. */
typedef struct trb_mover {
  int           first;     /* where its coordinates begin in a state */
  int           together;  /* of a roller: it steps with the hub */
  int           quiet;     /* steps with the hub in which it has touched nothing, one after the other */
  int           troubled;  /* the last solve failed */
  double        failing;   /* share of solves that failed, the last ones counting most */
  int           errors;    /* steps refused for their error, one after the other */
  int           poor;      /* a correction left too much of its equations */
  long          solves;    /* since its slopes were taken */
  double        slopes_at; /* when they were, s */
  int           age;       /* solves that the inverse of its own block was used for, where it steps alone */
  double        p[3][TRB_COURSE_ROOM], e[TRB_COURSE_ROOM], x[TRB_COURSE_ROOM];
  const double *flow; /* its rates, as they were evaluated last */
  double        left; /* what its equations lack, in tolerances */
  trb_course    course;
} trb_mover;

typedef struct trb_multirate {
  trb_jacobian       *jacobian;
  trb_arrow          *arrow;
  trb_arrow_factors  *factors; /* of the team with the hub, and of each roller by itself */
  trb_tangent_measure measure;
  trb_approximation   tangents;
  trb_mover          *movers; /* rollers, then the hub */
  double              hub_flow[TRB_COURSE_ROOM];
  int                 n_rollers, n_quadratures;
  int                 hub_body; /* number of the one body that the hub is */
  int                *together; /* rollers that step with the hub, ascending */
  int                 n_together;
  int                *joined; /* of them those that have no part in the Jacobian yet */
  int                 n_joined;
  int                 has_jacobian, has_factors; /* of the team with the hub as it is */
  int                 jacobian_age, factors_age; /* solves that they were used for */
  double             *y, *rates;                 /* scratch: a state and its rates */
  double             *error;                     /* of the last step of every body, by entry of the state */
  double             *packed, *weight, *taken;   /* scratch of Newton's method: the team's coordinates one after the other */
  size_t              stride;                    /* between corrections that were taken */
  trb_statistics      count;
  trb_memory          memory; /* of all arrays */
} trb_multirate;

/* A team: n rollers, and the hub or not. */
typedef struct trb_team {
  const int *rollers;
  int        n, with_hub;
} trb_team;

typedef enum trb_outcome { TRB_STEP_GOOD, TRB_STEP_UNSOLVED, TRB_STEP_WRONG } trb_outcome;

static inline int        trb_team_size(const trb_team *team) { return team->n + team->with_hub; }
static inline trb_mover *trb_team_mover(const trb_multirate *s, const trb_team *team, int k)
{
  return &s->movers[k < team->n ? team->rollers[k] : s->n_rollers];
}
/* The one whose course says when the team steps, and how far. */
static inline trb_mover *trb_team_head(const trb_multirate *s, const trb_team *team)
{
  return trb_team_mover(s, team, trb_team_size(team) - 1);
}

/* Rates of the bodies of a team at their states x, into their flows. */
void trb_multirate_flows(trb_integrator *it, const trb_team *team, double time, double gamma, int exact);
/* Tries the next step of a team, which ends at a time; every body's e is its solution. error: the largest error of a body, in tolerances. */
trb_outcome trb_multirate_try(trb_integrator *it, const trb_team *team, double end, double *error);

/* Lists the rollers that step with the hub. */
void trb_multirate_list(trb_multirate *s);
/* Rollers by themselves that touch something at the end of the step that the hub has tried join it where it began; gives how many. */
int trb_multirate_join(trb_integrator *it, double end);
/* Rollers of the hub's team that have touched nothing for long leave it, after a step. */
void trb_multirate_leave(trb_integrator *it);

#endif
