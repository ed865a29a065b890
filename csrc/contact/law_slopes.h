/* Slopes of the laws of raceway contacts, node by node (docs/theory/numerics.md#slopes-of-the-laws). Load, friction and rolling resistance of a node
 * depend on its interference, its mean and its sliding speed alone, and rolling resistance also on the interference that stands for the length
 * that rolls. Their slopes over the logarithms of these four are taken once, by differences; of a roller that is moved by a little, the laws
 * are then followed along them, and the geometry and the sums are evaluated as always. Included by the raceway kernel only. */
#ifndef TRB_CONTACT_LAW_SLOPES_H
#define TRB_CONTACT_LAW_SLOPES_H

/* Change of a logarithm by which slopes are taken. */
#define TRB_LAW_STEP 1e-7

/* Whether a contact has lanes; followed laws have those of the place where they were kept. */
static int carries(const trb_race_input *in, double depth) { return in->laws != NULL && in->linear ? in->laws->loaded : depth > 0.0; }

/* Friction coefficients of all lanes, and rolling resistance per length. */
static void evaluate_laws(const trb_model *m, const trb_pass_kind *kind, int n, int rolling, trb_lanes *l, trb_counters *counters)
{
  if (m->film) pass_film(m, n, l);
  pass_oil(m, kind, n, l, counters);
  if (rolling) pass_rollings(m, n, l, counters);
}

/* What a node's laws give beyond that of another evaluation, per change of the logarithm. */
static void take_slope(int n, const trb_lanes *l, const double *mu, const double *rolling, double *restrict mu_slope,
                       double *restrict rolling_slope)
{
  for (int i = 0; i < n; i++) {
    mu_slope[i] = (l->friction_coefficient[i] - mu[i]) / TRB_LAW_STEP;
    rolling_slope[i] = (l->rolling[i] - rolling[i]) / TRB_LAW_STEP;
  }
}

/* Multiplies speeds by factors. */
static void change_speeds(int n, double mean, double sliding, trb_lanes *l)
{
  const double more = log(mean), ratio = sliding / mean;
  for (int i = 0; i < n; i++) {
    l->mean_speed[i] *= mean;
    l->log_u[i] += more;
    l->sliding_speed[i] *= sliding;
    l->slide_roll[i] *= ratio;
  }
}

/* Keeps values and slopes of the laws of contacts that were evaluated; lanes are used up. */
static void keep_laws(const trb_model *m, const trb_pass_kind *kind, const trb_race_input *inputs, const int *loaded, int n_loaded,
                      int rolling, trb_lanes *l, trb_counters *counters)
{
  double       kept[TRB_N_LAW_SLOPES][TRB_LANE_STRIDE];
  const int    n = m->n_lanes, all = n_loaded * n;
  const double step = 1.0 + TRB_LAW_STEP, back = 1.0 / step;
  double      *mu = kept[TRB_LAW_friction], *rolls = kept[TRB_LAW_rolling];
  for (int i = 0; i < all; i++) {
    l->rolled[i] = 1.0;
    l->friction_coefficient[i] = m->friction ? l->friction_coefficient[i] : 0.0;
    kept[TRB_LAW_interference][i] = l->interference[i];
    kept[TRB_LAW_per_mean_speed][i] = 1.0 / l->mean_speed[i];
    kept[TRB_LAW_per_sliding_speed][i] = 1.0 / l->sliding_speed[i];
    kept[TRB_LAW_log_d][i] = l->log_d[i];
    kept[TRB_LAW_load][i] = l->interference[i] > 0.0 ? l->load_per_length[i] * l->weight[i] : 0.0;
    kept[TRB_LAW_rolled_log_d][i] = rolling ? l->rolled_log_d[i] : 0.0;
    kept[TRB_LAW_film_ratio][i] = rolling ? l->film_elastic[i] / l->film_rigid[i] : 0.0;
    if (!rolling) l->rolling[i] = 0.0;
  }
  if (rolling) pass_rollings(m, all, l, counters);
  copy_lanes(all, l->friction_coefficient, mu);
  copy_lanes(all, l->rolling, rolls);
  for (int i = 0; i < all; i++) l->rolled_log_d[i] += TRB_LAW_STEP;
  if (rolling) pass_rollings(m, all, l, counters);
  take_slope(all, l, mu, rolls, kept[TRB_LAW_friction_d], kept[TRB_LAW_rolling_end]);
  for (int i = 0; i < all; i++) l->rolled_log_d[i] -= TRB_LAW_STEP;
  change_speeds(all, step, 1.0, l);
  evaluate_laws(m, kind, all, rolling, l, counters);
  take_slope(all, l, mu, rolls, kept[TRB_LAW_friction_u], kept[TRB_LAW_rolling_u]);
  change_speeds(all, back, step, l);
  evaluate_laws(m, kind, all, rolling, l, counters);
  take_slope(all, l, mu, rolls, kept[TRB_LAW_friction_s], kept[TRB_LAW_rolling_s]);
  change_speeds(all, 1.0, back, l);
  for (int i = 0; i < all; i++) l->interference[i] *= step;
  pass_load(m, all, l);
  evaluate_laws(m, kind, all, rolling, l, counters);
  take_slope(all, l, mu, rolls, kept[TRB_LAW_friction_d], kept[TRB_LAW_rolling_d]);
  for (int c = 0; c < n_loaded; c++) {
    trb_law_slopes *to = inputs[loaded[c]].laws;
    to->loaded = 1;
    for (int f = 0; f < TRB_N_LAW_SLOPES; f++) copy_lanes(n, kept[f] + c * n, to->nodes + f * n);
  }
}

/* Laws of a contact's nodes along their slopes; gives the power of damping. */
static double follow_contact(const trb_model *m, const trb_law_slopes *from, int first, int rolling, trb_lanes *l)
{
  const int     n = m->n_lanes;
  const double *k = from->nodes, floor2 = m->params.friction.speed_floor * m->params.friction.speed_floor;
#define KEPT(name) k[TRB_LAW_##name * n + i]
  TRB_PADDED(n);
  TRB_LANES for (int i = 0; i < n; i++)
  {
    const int    at = first + i;
    const double d = KEPT(interference), mean = sqrt(l->mx[at] * l->mx[at] + l->my[at] * l->my[at] + l->mz[at] * l->mz[at] + floor2),
                 slide =
                     sqrt(l->sx[at] * l->sx[at] + l->sy[at] * l->sy[at] + l->sz[at] * l->sz[at] + TRB_SLIDING_GUARD * TRB_SLIDING_GUARD);
    const double deeper = d > 0.0 ? (l->interference[at] - d) / d : 0.0, faster = mean * KEPT(per_mean_speed) - 1.0,
                 slips = slide * KEPT(per_sliding_speed) - 1.0;
    l->mean_speed[at] = mean;
    l->sliding_speed[at] = slide;
    l->log_d[at] = KEPT(log_d) + deeper;
    l->load[at] = KEPT(load) * (1.0 + TRB_PALMGREN_EXPONENT * deeper);
    l->friction_coefficient[at] = KEPT(friction) + KEPT(friction_d) * deeper + KEPT(friction_u) * faster + KEPT(friction_s) * slips;
    l->rolling[at] = KEPT(rolling) + KEPT(rolling_d) * deeper + KEPT(rolling_u) * faster + KEPT(rolling_s) * slips;
    l->film_elastic[at] = KEPT(film_ratio) * (1.0 + TRB_FILM_RATIO_EXPONENT * deeper + TRB_FILM_RATIO_SPEED * faster);
    l->film_rigid[at] = 1.0;
  }
  const double power = m->contact_damping > 0.0 ? pass_damping(m, first, n, l) : 0.0;
  if (!rolling) return power;
  pass_rolled(m, first, l);
  TRB_LANES for (int i = 0; i < n; i++)
  {
    const int at = first + i;
    l->rolling[at] = l->rolled[at] * (l->rolling[at] + KEPT(rolling_end) * (l->rolled_log_d[at] - KEPT(rolled_log_d)));
  }
#undef KEPT
  return power;
}

static void follow_laws(const trb_model *m, const trb_race_input *inputs, const int *loaded, int n_loaded, int rolling, trb_lanes *l,
                        trb_race_output *outputs)
{
  for (int c = 0; c < n_loaded; c++)
    outputs[loaded[c]].power_damping = follow_contact(m, inputs[loaded[c]].laws, c * m->n_lanes, rolling, l);
}

#endif
