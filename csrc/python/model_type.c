/* trbdyn._core.Model */
#include "python/core.h"

#include <string.h>

#include "contact/kernels.h"
#include "motion/equilibrium.h"
#include "motion/peak_look.h"
#include "motion/peaks.h"
#include "motion/record.h"
#include "system/assembly.h"

/* Arguments of a model, by number: arrays of so many dimensions. */
enum { PARAMS, DEVIATION, FACES, MODES, FORM, DROPS, N_ARRAYS };

/* The system of a model of these arrays, which may be NULL from MODES on. */
static trb_status make_system(PyArrayObject *const *a, trb_model **model, trb_system **system, trb_message *message)
{
#define ROWS(array) PyArray_DATA(a[array]), (int)PyArray_DIM(a[array], 0)
#define TABLE_OF(array) ROWS(array), (int)PyArray_DIM(a[array], 1), message
  if (PyArray_DIM(a[PARAMS], 0) != TRB_N_PARAMS)
    return trb_fail(message, TRB_ERR_INPUT, "params: %d values needed, %d given", TRB_N_PARAMS, (int)PyArray_DIM(a[PARAMS], 0));
  if (PyArray_DIM(a[FACES], 0) > 0 && PyArray_DIM(a[FACES], 1) != TRB_N_FACE_COLUMNS)
    return trb_fail(message, TRB_ERR_INPUT, "faces: %d columns needed, %d given", TRB_N_FACE_COLUMNS, (int)PyArray_DIM(a[FACES], 1));
  trb_status status = trb_model_create(PyArray_DATA(a[PARAMS]), ROWS(DEVIATION), ROWS(FACES), model, message);
  if (status == TRB_OK && a[MODES] != NULL) status = trb_model_set_modes(*model, TABLE_OF(MODES));
  if (status == TRB_OK && a[FORM] != NULL) status = trb_model_set_form(*model, TABLE_OF(FORM));
  if (status == TRB_OK && a[DROPS] != NULL) status = trb_model_set_drops(*model, TABLE_OF(DROPS));
#undef ROWS
#undef TABLE_OF
  return status == TRB_OK ? trb_system_tapered(*model, system, message) : status;
}

static PyObject *model_new(PyTypeObject *type, PyObject *args, PyObject *keywords)
{
  static char     *names[] = {"params", "diameter_deviation", "faces", "instruction_set", "modes", "form", "drops", NULL};
  static const int dimensions[N_ARRAYS] = {1, 1, 2, 2, 2, 2};
  PyObject        *given[N_ARRAYS] = {NULL};
  PyArrayObject   *arrays[N_ARRAYS] = {NULL};
  const char      *variant = "";
  if (!PyArg_ParseTupleAndKeywords(args, keywords, "OOO|sOOO", names, &given[PARAMS], &given[DEVIATION], &given[FACES], &variant,
                                   &given[MODES], &given[FORM], &given[DROPS]))
    return NULL;
  model_object  *self = NULL;
  trb_model     *model = NULL;
  trb_system    *system = NULL;
  trb_workspace *work = NULL;
  trb_message    message = {TRB_OK, ""};
  trb_status     status = TRB_OK;
  int            complete = 1;
  for (int i = 0; i < N_ARRAYS && complete; i++)
    if (given[i] != NULL) complete = (arrays[i] = trb_array(given[i], dimensions[i], names[i < MODES ? i : i + 1])) != NULL;
  if (complete) {
    status = make_system(arrays, &model, &system, &message);
    /* a workspace tells whether the variant runs, and which one "" stands for */
    if (status == TRB_OK) status = trb_workspace_create(system->pairs, system->n_pairs, variant, &work, &message);
    if (status == TRB_OK) self = (model_object *)PyType_GenericAlloc(type, 0);
    if (status != TRB_OK) (void)trb_raise(status, &message);
  }
  if (self != NULL) {
    self->model = model;
    self->system = system;
    (void)PyOS_snprintf(self->variant, sizeof self->variant, "%s", trb_kernel_variants[work->variant].name);
  } else {
    trb_system_free(system);
    trb_model_free(model);
  }
  trb_workspace_free(work);
  for (int i = 0; i < N_ARRAYS; i++) Py_XDECREF((PyObject *)arrays[i]);
  return (PyObject *)self;
}

static void model_dealloc(PyObject *object)
{
  trb_system_free(((model_object *)object)->system);
  trb_model_free(((model_object *)object)->model);
  trb_release(object);
}

static PyObject *get_number(PyObject *self, void *closure)
{
  const trb_system *s = ((model_object *)self)->system;
  const char       *name = closure;
  if (strcmp(name, "n_rollers") == 0) return PyLong_FromLong(s->model->n_rollers);
  if (strcmp(name, "n_slots") == 0) return PyLong_FromLong(s->model->n_slots);
  if (strcmp(name, "n_state") == 0) return PyLong_FromLong(trb_state_size(s));
  if (strcmp(name, "peak_length") == 0) return PyLong_FromLong(trb_peak_offset(s, TRB_N_PEAK_FIELDS));
  return PyLong_FromLong(trb_record_offset(s, TRB_N_FIELDS));
}

static PyObject *get_variant(PyObject *self, void *closure)
{
  (void)closure;
  return PyUnicode_FromString(((model_object *)self)->variant);
}

static PyObject *shape_tuple(int n, const int *shape)
{
  if (n == 0) return PyTuple_New(0);
  return n == 1 ? Py_BuildValue("(i)", shape[0]) : Py_BuildValue("(ii)", shape[0], shape[1]);
}

/* Adds a row to a list; takes the row. */
static void append(PyObject **list, PyObject *row)
{
  if (*list != NULL && (row == NULL || PyList_Append(*list, row) != 0)) Py_CLEAR(*list);
  Py_XDECREF(row);
}

/* Adds a field to a layout, unless the system does not have it; gives the offset of the next one. */
static int append_field(PyObject **list, const trb_system *s, const char *name, int field, int offset)
{
  int       shape[2];
  const int n = trb_field_shape(s->model, trb_field_table[field].kind, shape), size = trb_field_size(s, field);
  if (size > 0) append(list, Py_BuildValue("(siN)", name, offset, shape_tuple(n, shape)));
  return offset + size;
}

static PyObject *record_layout(PyObject *self, PyObject *none)
{
  PyObject *list = PyList_New(0);
  (void)none;
  for (int i = 0, at = 0; i < TRB_N_FIELDS; i++) at = append_field(&list, ((model_object *)self)->system, trb_field_table[i].name, i, at);
  return list;
}

static PyObject *peak_layout(PyObject *self, PyObject *none)
{
  PyObject *list = PyList_New(0);
  (void)none;
  for (int i = 0, at = 0; i < TRB_N_PEAK_FIELDS; i++) {
    const trb_peak_field_info *peak = &trb_peak_field_table[i];
    at = append_field(&list, ((model_object *)self)->system, peak->name, trb_peak_quantities[peak->quantity].field, at);
  }
  return list;
}

/* A coordinate of a body, without blanks. */
static PyObject *state_name(const trb_body *body, int coordinate)
{
  char name[64];
  (void)PyOS_snprintf(name, sizeof name, "%s_%s", body->name, body->coordinates[coordinate].name);
  for (char *at = name; *at != '\0'; at++)
    if (*at == ' ') *at = '_';
  return PyUnicode_FromString(name);
}

/* A row for each part of the state: name, where it begins, shape and strides as (count, stride). A carried ring's coordinates are those of
 * the shaft. */
static PyObject *layout_of(const trb_system *s)
{
  PyObject *list = PyList_New(0);
  for (int i = 0; i < TRB_ROLLER_SIZE; i++)
    append(&list, Py_BuildValue("(Ni(ii))", PyUnicode_FromFormat("roller_%s", trb_roller_coordinates[i].name), trb_state_roller(s, 0) + i,
                                s->model->n_rollers, TRB_ROLLER_SIZE));
  for (int b = 0; b < s->n_bodies; b++)
    for (int c = 0; c < s->bodies[b].size; c++)
      append(&list, Py_BuildValue("(Ni())", state_name(&s->bodies[b], c), s->bodies[b].first + c));
  append(&list, Py_BuildValue("(si(i))", "spin_angle", trb_state_spin(s), s->model->n_rollers));
  append(&list, Py_BuildValue("(si(i))", "quadratures", trb_state_quadrature(s), trb_n_quadratures(s)));
  return list;
}

static PyObject *state_layout(PyObject *self, PyObject *none)
{
  (void)none;
  return layout_of(((model_object *)self)->system);
}

PyObject *trb_python_state_layouts(PyObject *module, PyObject *models)
{
  const trb_system *systems[TRB_MOST_MEMBERS];
  const Py_ssize_t  n = PyTuple_Check(models) ? PyTuple_Size(models) : 0;
  trb_message       message = {TRB_OK, ""};
  (void)module;
  for (Py_ssize_t k = 0; k < n && k < TRB_MOST_MEMBERS; k++) {
    PyObject *model = PyTuple_GetItem(models, k);
    if (!PyObject_TypeCheck(model, trb_model_type)) return PyErr_Format(PyExc_TypeError, "models: a tuple of Model");
    systems[k] = ((model_object *)model)->system;
  }
  trb_assembly *assembly = PyMem_Calloc(1, sizeof *assembly);
  if (assembly == NULL) return PyErr_NoMemory();
  const trb_status status = trb_assembly_make(systems, (int)n, assembly, &message);
  PyObject        *list = status == TRB_OK ? PyList_New(0) : trb_raise(status, &message), *out = NULL;
  for (int k = 0; k < assembly->n && status == TRB_OK; k++) append(&list, layout_of(&assembly->members[k]));
  if (list != NULL) out = Py_BuildValue("(iN)", trb_state_size(&assembly->members[0]), list);
  PyMem_Free(assembly);
  return out;
}

static const char *body_of(const trb_system *s, int body) { return body == TRB_ROLLERS ? "rollers" : s->bodies[body].name; }

static PyObject *system_table(PyObject *self, PyObject *none)
{
  const trb_system *s = ((model_object *)self)->system;
  PyObject         *bodies = PyList_New(0), *surfaces = PyList_New(0), *pairs = PyList_New(0);
  (void)none;
  for (int b = 0; b < s->n_bodies; b++)
    append(&bodies, Py_BuildValue("(ssi)", s->bodies[b].name, s->bodies[b].kind->name, s->bodies[b].size));
  for (int i = 0; i < s->n_surfaces; i++) append(&surfaces, Py_BuildValue("(ss)", s->surfaces[i].name, body_of(s, s->surfaces[i].body)));
  for (int i = 0; i < s->n_pairs; i++) {
    const trb_pair *pair = &s->pairs[i];
    append(&pairs, Py_BuildValue("(ssssO)", pair->name, pair->text, s->surfaces[pair->surface[0]].name, s->surfaces[pair->surface[1]].name,
                                 pair->on ? Py_True : Py_False));
  }
  if (bodies != NULL && surfaces != NULL && pairs != NULL)
    return Py_BuildValue("{s:N,s:N,s:N}", "bodies", bodies, "surfaces", surfaces, "pairs", pairs);
  Py_XDECREF(bodies);
  Py_XDECREF(surfaces);
  Py_XDECREF(pairs);
  return NULL;
}

static int read_doubles(PyObject *object, const char *name, npy_intp n, double *to)
{
  PyArrayObject *array = trb_array(object, 1, name);
  if (array == NULL) return -1;
  if (PyArray_DIM(array, 0) != n) {
    PyErr_Format(PyExc_ValueError, "%s: %d values needed, %d given", name, (int)n, (int)PyArray_DIM(array, 0));
    Py_DECREF((PyObject *)array);
    return -1;
  }
  memcpy(to, PyArray_DATA(array), (size_t)n * sizeof(double));
  Py_DECREF((PyObject *)array);
  return 0;
}

static PyObject *equilibrium(PyObject *self, PyObject *args, PyObject *keywords)
{
  static char     *names[] = {"load",  "fixed",     "displacement", "shaft_speed", "angles", "rollers",
                              "loads", "stiffness", "outer_speed",  "rough",       NULL};
  const trb_model *m = ((model_object *)self)->model;
  PyObject        *load, *fixed, *displacement, *angles, *rollers = Py_None;
  trb_equilibrium  e = {0};
  trb_message      message = {TRB_OK, ""};
  double           held[TRB_RING_FREEDOMS];
  int              with_loads = 0, with_stiffness = 0, rough = 0;
  double           stiffness[TRB_RING_FREEDOMS * TRB_RING_FREEDOMS] = {0};
  if (!PyArg_ParseTupleAndKeywords(args, keywords, "OOOdO|Oppdp", names, &load, &fixed, &displacement, &e.shaft_speed, &angles, &rollers,
                                   &with_loads, &with_stiffness, &e.carried_speed, &rough))
    return NULL;
  if (read_doubles(load, "load", TRB_RING_FREEDOMS, e.load) != 0 || read_doubles(fixed, "fixed", TRB_RING_FREEDOMS, held) != 0 ||
      read_doubles(displacement, "displacement", TRB_RING_FREEDOMS, e.displacement) != 0)
    return NULL;
  for (int i = 0; i < TRB_RING_FREEDOMS; i++) e.fixed[i] = held[i] != 0.0;
  const size_t n = (size_t)m->n_rollers;
  double      *block = PyMem_Calloc(n * (1 + TRB_ROLLER_FREEDOMS * (1 + TRB_RING_FREEDOMS) + TRB_EQUILIBRIUM_LOADS), sizeof(double));
  if (block == NULL) return PyErr_NoMemory();
  e.angles = block;
  e.rollers = block + n;
  PyObject *out = NULL;
  const int guessed = rollers != Py_None;
  e.warm = guessed && !rough;
  double *const loads = e.rollers + TRB_ROLLER_FREEDOMS * n;
  double *const follow = loads + TRB_EQUILIBRIUM_LOADS * n;
  e.loads = e.warm && !with_loads ? NULL : loads;
  e.stiffness = with_stiffness ? stiffness : NULL;
  e.follow = follow;
  if (read_doubles(angles, "angles", m->n_rollers, e.angles) == 0 &&
      (!guessed || read_doubles(rollers, "rollers", TRB_ROLLER_FREEDOMS * m->n_rollers, e.rollers) == 0)) {
    trb_status status;
    Py_BEGIN_ALLOW_THREADS
    status = trb_equilibrium_solve(((model_object *)self)->system, &e, &message);
    Py_END_ALLOW_THREADS
    if (status != TRB_OK) (void)trb_raise(status, &message);
    else
      out = Py_BuildValue("{s:N,s:N,s:N,s:d,s:N,s:N,s:d,s:i,s:N,s:N}", "displacement", trb_vector(e.displacement, TRB_RING_FREEDOMS),
                          "reaction", trb_vector(e.reaction, TRB_RING_FREEDOMS), "on_other", trb_vector(e.on_other, TRB_RING_FREEDOMS),
                          "energy", e.energy, "rollers", trb_matrix(e.rollers, m->n_rollers, TRB_ROLLER_FREEDOMS), "loads",
                          trb_matrix(loads, m->n_rollers, TRB_EQUILIBRIUM_LOADS), "residual", e.residual, "iterations", e.iterations,
                          "stiffness", trb_matrix(stiffness, TRB_RING_FREEDOMS, TRB_RING_FREEDOMS), "follow",
                          trb_matrix(follow, m->n_rollers, TRB_ROLLER_FREEDOMS * TRB_RING_FREEDOMS));
  }
  PyMem_Free(block);
  return out;
}

static PyMethodDef methods[] = {
    {"record_layout", record_layout, METH_NOARGS, "(name, offset, shape) of every field of a record."},
    {"peak_layout", peak_layout, METH_NOARGS, "(name, offset, shape) of every field of a row of peaks."},
    {"system_table", system_table, METH_NOARGS, "Bodies (name, kind, coordinates), surfaces and pairs that are simulated."},
    {"state_layout", state_layout, METH_NOARGS, "(name, offset, shape) of the parts of a state vector."},
    {"equilibrium", (PyCFunction)(void (*)(void))equilibrium, METH_VARARGS | METH_KEYWORDS, "Static equilibrium at speed."},
    {NULL, NULL, 0, NULL},
};

static PyGetSetDef properties[] = {
    {"n_rollers", get_number, NULL, "number of rollers", "n_rollers"},
    {"n_slots", get_number, NULL, "most faces in a pocket", "n_slots"},
    {"n_state", get_number, NULL, "length of a state vector", "n_state"},
    {"record_length", get_number, NULL, "length of a record", "record_length"},
    {"peak_length", get_number, NULL, "length of a row of peaks", "peak_length"},
    {"instruction_set", get_variant, NULL, "kernel variant in use", NULL},
    {NULL, NULL, NULL, NULL, NULL},
};

static PyType_Slot slots[] = {
    {Py_tp_dealloc, model_dealloc}, {Py_tp_doc, "One bearing with its lubricant and effects; immutable."},
    {Py_tp_methods, methods},       {Py_tp_getset, properties},
    {Py_tp_new, model_new},         {0, NULL},
};

PyType_Spec trb_model_spec = {
    .name = "trbdyn._core.Model",
    .basicsize = sizeof(model_object),
    .flags = Py_TPFLAGS_DEFAULT | Py_TPFLAGS_IMMUTABLETYPE,
    .slots = slots,
};
