/* The loops that take most of the time: the same sources compiled for several instruction sets (TRB_KERNEL_VARIANT), one of which is
 * chosen when a workspace is made. `scalar` is compiled without fast-math; the other variants are tested against it. A lane is one node
 * of one contact: its place in the arrays that the loops run over. */
#ifndef TRB_CONTACT_KERNELS_H
#define TRB_CONTACT_KERNELS_H

#include "contact/contact.h"

/* Lanes of scratch, at least the largest number of nodes; lanes that a tile is filled to, so that all fields of a tile stay in the first
 * cache; distance of the fields, no power of two, so that they share no cache set. */
enum { TRB_TILE_LANES = 256, TRB_TILE_FILL = 64, TRB_LANE_STRIDE = TRB_TILE_LANES + 8 };

/* Per lane. X(name, unit, text) */
#define TRB_LANE_FIELDS(X) \
  X(interference,   "m",   "interference of the undeformed surfaces") \
  X(load,           "N",   "normal load of the node") \
  X(load_per_length, "N/m", "load per length") \
  X(half_width,     "m",   "Hertz half width") \
  TRB_LAW_FIELDS(X) \
  X(traction_coefficient, "1", "friction coefficient of the full film") \
  X(boundary_coefficient, "1", "friction coefficient of boundary friction") \
  X(friction_coefficient, "1", "friction coefficient") \
  X(rolling,        "N",   "rolling resistance of each surface") \
  X(approach,       "m/s", "rate of the interference") \
  X(weight,         "m",   "quadrature weight along the contact") \
  X(rolled,         "m",   "length of the node's cell that has rolling resistance") \
  X(rolled_log_d,   "1",   "logarithm of the interference in this length") \
  X(supplied,       "1",   "share of rolling resistance that the supply of oil leaves") \
  X(radius,         "m",   "equivalent radius") \
  X(log_radius,     "1",   "its logarithm") \
  X(roller_share,   "1",   "share of the roller in the pair's curvature") \
  X(reach,          "m",   "roller axis to contact point, along the normal") \
  X(log_d,          "1",   "logarithm of the interference") \
  X(log_u,          "1",   "logarithm of the mean speed") \
  X(nx,             "1",   "normal, from roller to race") \
  X(ny,             "1",   "normal, tangential part") \
  X(nz,             "1",   "normal, axial part") \
  X(px,             "m",   "contact point, radial") \
  X(py,             "m",   "contact point, tangential") \
  X(pz,             "m",   "contact point, axial") \
  X(sx,             "m/s", "sliding velocity, roller minus race, radial") \
  X(sy,             "m/s", "sliding velocity, tangential") \
  X(sz,             "m/s", "sliding velocity, axial") \
  X(mx,             "m/s", "mean velocity, radial") \
  X(my,             "m/s", "mean velocity, tangential") \
  X(mz,             "m/s", "mean velocity, axial")

typedef struct trb_lanes {
#define TRB_LANE_MEMBER(name, unit, text) double name[TRB_LANE_STRIDE];
  TRB_LANE_FIELDS(TRB_LANE_MEMBER)
#undef TRB_LANE_MEMBER
} trb_lanes;

enum {
#define TRB_LANE_ENUM(name, unit, text) TRB_LANE_##name,
  TRB_LANE_FIELDS(TRB_LANE_ENUM)
#undef TRB_LANE_ENUM
      TRB_N_LANE_FIELDS
};

/* The nodes (n_lanes) of a lane field in a detail. */
static inline const double *trb_detail_lane(const trb_model *m, const trb_detail *detail, int field, int race, int roller)
{
  const size_t lanes = (size_t)m->n_lanes, rollers = (size_t)m->n_rollers;
  return detail->lanes + (((size_t)field * TRB_N_RACES + (size_t)race) * rollers + (size_t)roller) * lanes;
}

typedef struct trb_uneven trb_uneven;

/* Of each node, what its laws gave where they were kept, and their slopes over logarithms: _d of the interference, _end of that which stands for the length
 * that rolls, _u of the mean speed, _s of the sliding speed (contact/law_slopes.h). Rolling resistance is per length; per_: one over it; film_ratio: elastic over rigid. */
#define TRB_LAW_SLOPES(X) \
  X(interference) X(per_mean_speed) X(per_sliding_speed) X(log_d) X(load) X(friction) X(friction_d) X(friction_u) X(friction_s) X(film_ratio) X(rolled_log_d) X(rolling) \
  X(rolling_d) X(rolling_end) X(rolling_u) X(rolling_s)

enum {
#define TRB_LAW_ENUM(name) TRB_LAW_##name,
  TRB_LAW_SLOPES(TRB_LAW_ENUM)
#undef TRB_LAW_ENUM
      TRB_N_LAW_SLOPES
};

/* Of one contact. */
typedef struct trb_law_slopes {
  int     loaded; /* whether it carried a load */
  double *nodes;  /* [field][lane] */
} trb_law_slopes;

/* One contact of a roller with a race. Without interference it uses no lanes: the next contact gets them. */
typedef struct trb_race_input {
  const trb_roller_pose *roller;
  const trb_ring_pose   *ring;   /* in the roller's frame */
  const trb_cone        *cone;   /* the race, about the ring's axis */
  const double          *centre; /* spheres of this roller, per lane */
  const double          *sphere;
  const trb_race_nodes  *nodes;
  const trb_uneven      *uneven; /* NULL: both surfaces have their true form there */
  trb_law_slopes        *laws;   /* where slopes of its laws are kept; NULL: nowhere */
  int                    lane;   /* the first of its lanes in `uneven` */
  int                    linear; /* 1: its laws are followed along them */
} trb_race_input;

typedef struct trb_race_output {
  trb_vec3 force, moment;                   /* on the roller, about its centre of mass */
  trb_vec3 ring_force, ring_moment;         /* on the race, about ring->centre */
  double   torque_traction, torque_rolling; /* on the race, about its axis */
  double   elastic, power_traction, power_rolling, power_pressure, power_damping;
  double   depth;  /* largest interference, m; negative: the gap */
  int      loaded; /* 0: no interference, all forces are zero */
} trb_race_output;

static inline trb_load trb_load_of_output(const trb_race_output *out)
{
  return (trb_load){.on_a = {out->force, out->moment},
                    .on_b = {out->ring_force, out->ring_moment},
                    .elastic = out->elastic,
                    .lost = {[TRB_BY_SLIDING] = out->power_traction,
                             [TRB_BY_ROLLING] = out->power_rolling,
                             [TRB_BY_ROLLING_PRESSURE] = out->power_pressure,
                             [TRB_BY_DAMPING] = out->power_damping},
                    .torque = {[TRB_BY_SLIDING] = out->torque_traction, [TRB_BY_ROLLING] = out->torque_rolling}};
}

typedef void trb_raceway_kernel(const trb_model *m, const trb_race_input *inputs, int n, trb_lanes *lanes, trb_counters *counters,
                                trb_race_output *outputs);

/* Ends of the chosen rollers on a rib: each roller has one lane and one output. ring: of each roller, in its frame. */
typedef void trb_rib_kernel(const trb_model *m, const trb_rib *rib, const trb_instant *at, const trb_ring_pose *ring, trb_lanes *lanes,
                            trb_counters *counters, trb_race_output *outputs);

trb_raceway_kernel trb_raceway_kernel_scalar, trb_raceway_kernel_base, trb_raceway_kernel_avx2, trb_raceway_kernel_avx512;
trb_rib_kernel     trb_rib_kernel_scalar, trb_rib_kernel_base, trb_rib_kernel_avx2, trb_rib_kernel_avx512;

extern const trb_modal_kernels trb_modal_kernels_scalar, trb_modal_kernels_base, trb_modal_kernels_avx2, trb_modal_kernels_avx512;

typedef struct trb_kernel_variant {
  const char              *name;
  trb_raceway_kernel      *raceway;
  trb_rib_kernel          *rib;
  const trb_modal_kernels *modal;
} trb_kernel_variant;

/* Variants that were built, slowest first. */
extern const trb_kernel_variant trb_kernel_variants[];
extern const int                trb_n_kernel_variants;

/* Whether this machine can run a variant. */
int trb_kernel_runs(int variant);

#endif
