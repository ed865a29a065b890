/* Dense kernels of the integrator. block_kernel.c is compiled once for each instruction set, as the kernels of the contacts are, and the
 * variants have the same order as trb_kernel_variants. All of them are compiled without fast-math. */
#ifndef TRB_STEPPING_BLOCKS_H
#define TRB_STEPPING_BLOCKS_H

#include "motion/dynamics.h"
#include "stepping/ring_tangent.h"

/* TRB_NP: a roller's entries, padded; TRB_TANGENT_IN: a roller's state and the angle of the frame; TRB_TANGENT_OUT: its flow, padded. */
enum { TRB_NR = TRB_ROLLER_SIZE, TRB_NP = 12, TRB_TANGENT_IN = TRB_NP, TRB_TANGENT_OUT = TRB_FLOW_ROOM };
_Static_assert((int)TRB_RING_OF_ROLLER == (int)TRB_TANGENT_IN, "a ring's part of a tangent has the roller's inputs, too");

/* The hub: all bodies that are not rolling elements, with `width` coordinates together. The width is known when a simulation is made.
 * Columns of the hub's length are padded by zeros to a multiple of TRB_NP, their room, so that loops over them have no remainder. They
 * are made of parts of TRB_NP entries, and a border says which parts it has: a roller that touches no pocket has none of the cage. The
 * width of one rigid body, the cage alone, has loops of its own. */
enum { TRB_HUB_ONE_BODY = TRB_NP };
static inline int trb_hub_room(int width) { return (width + TRB_NP - 1) / TRB_NP * TRB_NP; }

/* Block and borders of a roller. They are stored apart, so that the blocks, which every system needs, lie in one stretch of memory. */
typedef struct trb_arrow_block {
  double own[TRB_NR][TRB_NP]; /* d roller / d roller, column by column, padded by zeros */
} trb_arrow_block;

/* Column by column; the arrays belong to the matrix. */
typedef struct trb_arrow_border {
  double  *to_hub; /* [width][TRB_NR]: d roller / d hub */
  double  *from;   /* [TRB_NR][room]: d hub / d roller */
  unsigned parts;  /* bits of the parts of the hub that are not zero, whatever the others hold */
} trb_arrow_border;

/* Bits of the parts of a hub in which some of its entries lie. */
static inline unsigned trb_hub_parts(int first, int n) { return (2U << ((first + n - 1) / TRB_NP)) - (1U << (first / TRB_NP)); }

/* Columns are contiguous, so that a product with a vector is a sum of columns. */
typedef struct trb_arrow_factor_block {
  double inverse[TRB_NR][TRB_NP]; /* column by column: inverse of the roller's block */
} trb_arrow_factor_block;

typedef struct trb_arrow_factor_border {
  double  *solved; /* [width][TRB_NP]: inverse to_hub */
  double  *from;   /* [room / TRB_NP][TRB_NR][TRB_NP]: border of the hub's rows, part by part */
  unsigned parts;
} trb_arrow_factor_border;

/* The hub's Schur complement, and memory for the kernels. */
typedef struct trb_hub_factor {
  int     width, room;
  double *schur;   /* [width][room], column by column; the kernels may use its memory */
  double *inverse; /* of it, likewise */
  double *scratch; /* 2 room, and TRB_NP for each roller */
  int    *pivot;   /* width */
} trb_hub_factor;

typedef struct trb_block_kernels {
  /* Of I - gamma J: the inverse of a roller's block; 0: singular. */
  int (*factor)(const trb_arrow_block *b, double gamma, trb_arrow_factor_block *g);
  /* What a roller's border adds to a solution, and its share of the Schur complement; parts that it has not are not written. */
  void (*border)(const trb_arrow_border *b, double gamma, const trb_arrow_factor_block *own, trb_arrow_factor_border *g,
                 const trb_hub_factor *hub);
  /* Inverse of the Schur complement; 0: singular. */
  int (*invert_hub)(const trb_hub_factor *hub);
  /* x: n chosen rollers (NULL: the first n) then hub, overwritten by the solution. The entry after the last roller is read and written back: it must be
   * there even if the hub has no entries. */
  void (*solve)(const trb_arrow_factor_block *own, const trb_arrow_factor_border *border, const int *chosen, int n,
                const trb_hub_factor *hub, double *x);
  /* Adds columns, `stride` apart, times a vector of n to TRB_NP entries. */
  void (*add)(const double *columns, int stride, int n, const double *x, double *to);
  /* Step from an origin to a roller's state and an angle; gives the sum of squares of step times per. It reads TRB_NP entries of
   * y. */
  double (*step_from)(const double *origin, const double *per, const double *y, double turn, double *step);
  /* flow = value + slope step + bend curve, but no less than least; slope is stored column by column. */
  void (*follow)(const double *value, const double (*slope)[TRB_TANGENT_OUT], const double *step, const double *curve, double bend,
                 const double *least, double *flow);
  /* Adds what a ring's step does to a flow, which is then no less than least, and gives the reaction on the ring; see stepping/tangent.h.
   * step: of the roller's inputs; of_ring: of the ring's. */
  void (*follow_ring)(const trb_ring_slopes *slopes, const double *value, const double *step, const double *of_ring, const double *least,
                      double *flow, double *reaction);
  /* Adds to the borders of a roller what a ring with n <= TRB_NP coordinates does. response: of the ring's rates to each entry of a wrench; with: slopes of
   * the ring's inputs with each coordinate. from: the roller's columns of the hub's rows, `room` apart, at the ring's first one; to_hub: columns of
   * the ring's coordinates. To reactions, one for each coordinate, is added what moves the ring against the roller. */
  void (*border_ring)(const trb_ring_slopes *slopes, const double (*response)[TRB_NP], const double (*with)[TRB_RING_IN], int n, int room,
                      double *from, double *to_hub, double (*reactions)[TRB_RING_OUT]);
  /* Error weights 1/(relative |y| + scale). */
  void (*weigh)(const double *relative, const double *scale, const double *y, int n, double *weights);
  /* Whether all entries are finite. */
  int (*finite)(const double *x, int n);
} trb_block_kernels;

extern const trb_block_kernels trb_block_kernels_scalar, trb_block_kernels_base, trb_block_kernels_avx2, trb_block_kernels_avx512;

/* Kernels of a variant, an index into trb_kernel_variants. */
const trb_block_kernels *trb_block_kernels_of(int variant);

/* The Jacobian J in these blocks (stepping/arrow.h). */
typedef struct trb_arrow {
  int               n;           /* rollers */
  int               width, room; /* of the hub: its entries, and the length of its columns */
  double            gamma;       /* of the system matrix I - gamma J */
  trb_arrow_block  *rollers;     /* n */
  trb_arrow_border *borders;     /* n */
  double           *hub;         /* [width][room], column by column, padded by zeros */
  trb_memory        memory;      /* of all arrays */
} trb_arrow;

#endif
