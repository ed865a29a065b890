/* What a user sees of the contacts at a state: arrays and numbers by name. */
#include "python/core.h"

#include <stddef.h>
#include <string.h>

#include "contact/kernels.h"

/* Every lane field of the raceways, shape (race, roller, node), and every field of the ribs, shape (roller,). */
static int put_detail(const trb_system *system, const trb_detail *detail, PyObject *out)
{
  const trb_model *m = system->model;
#define NAME(name, unit, text) #name,
  static const char *const lanes[] = {TRB_LANE_FIELDS(NAME)}, *const points[] = {TRB_POINT_FIELDS(NAME)};
#undef NAME
  for (int f = 0; f < TRB_N_LANE_FIELDS; f++) {
    npy_intp  shape[3] = {TRB_N_RACES, m->n_rollers, m->n_nodes};
    PyObject *array = PyArray_SimpleNew(3, shape, NPY_DOUBLE);
    if (array == NULL) return -1;
    double *to = PyArray_DATA((PyArrayObject *)array);
    for (int race = 0; race < TRB_N_RACES; race++)
      for (int j = 0; j < m->n_rollers; j++, to += m->n_nodes)
        memcpy(to, trb_detail_lane(m, detail, f, race, j), (size_t)m->n_nodes * sizeof(double));
    char key[64];
    (void)PyOS_snprintf(key, sizeof key, "raceway_%s", lanes[f]);
    if (trb_put(out, key, array) != 0) return -1;
  }
  const int count = (int)(sizeof points / sizeof points[0]);
  for (int f = 0; f < system->n_pairs * count; f++) {
    const trb_pair *pair = &system->pairs[f / count];
    if (pair->kind->contact == TRB_CONTACT_NONE || pair->kind->contact == TRB_CONTACT_LINE) continue;
    const trb_contact *from = trb_pair_contacts(m, pair, detail);
    PyObject          *array = trb_vector(NULL, m->n_rollers);
    if (array == NULL) return -1;
    for (int j = 0; j < m->n_rollers; j++) ((double *)PyArray_DATA((PyArrayObject *)array))[j] = ((const double *)&from[j])[f % count];
    char key[64];
    (void)PyOS_snprintf(key, sizeof key, "%s_%s", pair->name, points[f % count]);
    if (trb_put(out, key, array) != 0) return -1;
  }
  const double *pocket[] = {detail->pocket_force, detail->pocket_friction, detail->pocket_interference};
  const char   *keys[] = {"pocket_load", "pocket_friction", "pocket_interference"};
  for (int f = 0; f < 3; f++) {
    if (trb_put(out, keys[f], trb_matrix(pocket[f], m->n_rollers, m->n_slots)) != 0) return -1;
  }
  return 0;
}

/* Wrenches of every roller's contacts, in the frames that trb_load documents, shape (roller, width). */
static int put_loads(const trb_model *m, const trb_loads *loads, PyObject *out)
{
  const struct {
    const char *key;
    size_t      offset;
    int         width;
  } parts[] = {{"force", offsetof(trb_loads, roller.force), 3},
               {"moment", offsetof(trb_loads, roller.moment), 3},
               {"ring_force", offsetof(trb_loads, on[TRB_BODY_INNER_RING].force), 3},
               {"ring_moment", offsetof(trb_loads, on[TRB_BODY_INNER_RING].moment), 3},
               {"outer_force", offsetof(trb_loads, on[TRB_BODY_OUTER_RING].force), 3},
               {"outer_moment", offsetof(trb_loads, on[TRB_BODY_OUTER_RING].moment), 3},
               {"cage_force", offsetof(trb_loads, on[TRB_BODY_CAGE].force), 3},
               {"cage_moment", offsetof(trb_loads, on[TRB_BODY_CAGE].moment), 3},
               {"elastic_energy", offsetof(trb_loads, elastic), 1},
               {"power", offsetof(trb_loads, power), m->n_losses}};
  for (size_t p = 0; p < sizeof parts / sizeof parts[0]; p++) {
    PyObject *array = trb_matrix(NULL, m->n_rollers, parts[p].width);
    if (array == NULL) return -1;
    for (int j = 0; j < m->n_rollers; j++)
      memcpy((double *)PyArray_DATA((PyArrayObject *)array) + j * parts[p].width, (const char *)&loads[j] + parts[p].offset,
             (size_t)parts[p].width * sizeof(double));
    if (trb_put(out, parts[p].key, array) != 0) return -1;
  }
  return 0;
}

/* A number, shape (). */
static int put_scalar(PyObject *out, const char *key, double value)
{
  PyObject *array = PyArray_SimpleNew(0, NULL, NPY_DOUBLE);
  if (array != NULL) *(double *)PyArray_DATA((PyArrayObject *)array) = value;
  return trb_put(out, key, array);
}

/* The cage on a land, and wrenches of the pairs without a roller, in R. */
static int put_hub(const trb_model *m, const trb_detail *detail, const trb_loads *hub, PyObject *out)
{
#define PUT_LAND(X, name, unit, text) \
  if (put_scalar(out, "land_" #name, detail->land.name) != 0) return -1;
  TRB_LAND_FIELDS(PUT_LAND, 0)
#undef PUT_LAND
  static const struct {
    const char *key;
    int         body;
  } bodies[] = {{"cage", TRB_BODY_CAGE}, {"ring", TRB_BODY_INNER_RING}, {"outer", TRB_BODY_OUTER_RING}};
  for (size_t b = 0; b < sizeof bodies / sizeof bodies[0]; b++) {
    char key[64];
    (void)PyOS_snprintf(key, sizeof key, "hub_%s_force", bodies[b].key);
    if (trb_put(out, key, trb_vector(&hub->on[bodies[b].body].force.x, 3)) != 0) return -1;
    (void)PyOS_snprintf(key, sizeof key, "hub_%s_moment", bodies[b].key);
    if (trb_put(out, key, trb_vector(&hub->on[bodies[b].body].moment.x, 3)) != 0) return -1;
  }
  if (put_scalar(out, "hub_elastic_energy", hub->elastic) != 0) return -1;
  return trb_put(out, "hub_power", trb_vector(hub->power, m->n_losses));
}

int trb_put_contacts(const trb_system *system, const trb_detail *detail, const trb_loads *loads, const trb_loads *hub, PyObject *out)
{
  const trb_model *m = system->model;
  if (put_detail(system, detail, out) != 0 || put_loads(m, loads, out) != 0) return -1;
  return put_hub(m, detail, hub, out);
}
