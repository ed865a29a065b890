/* Coordinates of the hub whose rate is another one times a constant, as the amplitudes of modes are: y_s' = a y_v. Their rows of the system
 * I - gamma J say y_s = r_s + gamma a y_v, so they are eliminated before anything else: the column of s is added to that of v, and what is
 * solved is a hub of the entries that are kept. */
#ifndef TRB_STEPPING_FOLLOWERS_H
#define TRB_STEPPING_FOLLOWERS_H

#include "stepping/blocks.h"

typedef struct trb_followers {
  int              n, kept;        /* followers, and entries that are kept */
  int              width, room;    /* of the whole hub */
  int             *entry, *leader; /* [n]: of each follower in the hub, and of the one that it follows among the kept ones */
  int             *kept_entry;     /* [kept] */
  double          *rate;           /* [n]: gamma a */
  double          *hub;            /* [n][room]: gamma times the follower's column in the rows of the hub */
  double          *rollers;        /* [roller][n][TRB_NP]: in the rows of the rollers */
  double          *own;            /* [n]: right-hand sides of their equations */
  trb_arrow_border folded;         /* of a roller, scratch */
  int             *place;          /* [width]: of every entry among those that are kept */
  trb_memory       memory;         /* of all arrays */
} trb_followers;

/* entries: two a follower: its own and that of the one that it follows. */
trb_status trb_followers_create(int n_rollers, int hub_width, int n, const int (*entries)[2], trb_followers **followers,
                                trb_message *message);
void       trb_followers_free(trb_followers *followers);
/* Of I - gamma J without the followers: the hub's block, and a roller's border, which is kept in the followers. */
void                    trb_followers_hub(trb_followers *f, const trb_arrow *arrow, double gamma, const trb_hub_factor *hub);
const trb_arrow_border *trb_followers_border(trb_followers *f, const trb_arrow *arrow, double gamma, int roller);
/* Before a solution, and after it; x: as trb_arrow_solve takes it. */
void trb_followers_before(trb_followers *f, const trb_block_kernels *kernels, const trb_arrow_factor_border *borders, int n_rollers,
                          double *x);
void trb_followers_after(const trb_followers *f, int n_rollers, double *x);

#endif
