/* trbdyn._core.Simulation: made, stepped, set to a state, and its table of methods. */
#include "python/simulation_object.h"

#include <math.h>
#include <string.h>

/* Settings by name out of a dict; integrator is the one that is not a number. */
static int read_settings(PyObject *dictionary, trb_settings *settings, const char **kind)
{
  double    *values = (double *)settings;
  PyObject  *key, *value;
  Py_ssize_t position = 0;
  *kind = "auto";
  for (int i = 0; i < TRB_N_SETTINGS; i++) values[i] = trb_setting_table[i].standard;
  while (PyDict_Next(dictionary, &position, &key, &value)) {
    const char *name = PyUnicode_AsUTF8AndSize(key, NULL);
    if (name == NULL) return -1;
    if (strcmp(name, "integrator") == 0) {
      if ((*kind = PyUnicode_AsUTF8AndSize(value, NULL)) == NULL) return -1;
      continue;
    }
    int found = -1;
    for (int i = 0; i < TRB_N_SETTINGS; i++)
      if (strcmp(name, trb_setting_table[i].name) == 0) found = i;
    if (found < 0) {
      PyErr_Format(PyExc_ValueError, "setting '%s': not one of setting_table()", name);
      return -1;
    }
    values[found] = PyFloat_AsDouble(value);
    if (values[found] == -1.0 && PyErr_Occurred()) return -1;
  }
  return 0;
}

PyArrayObject *trb_python_state_array(const simulation_object *self, PyObject *object)
{
  PyArrayObject *state = trb_array(object, 1, "state");
  const int      n = self->simulation->integrator.n;
  if (state != NULL && PyArray_DIM(state, 0) != n) {
    PyErr_Format(PyExc_ValueError, "state: %d values needed, %d given", n, (int)PyArray_DIM(state, 0));
    Py_CLEAR(state);
  }
  return state;
}

/* What is prescribed for a bearing: a table, or a table with the period of its last part and with a time and the angles of shaft and outer
 * ring then. */
static int read_motion(PyObject *object, trb_motion **to)
{
  PyObject   *table = object;
  double      period = 0.0, angle_time = NAN, shaft = 0.0, outer = 0.0;
  trb_message message = {TRB_OK, ""};
  trb_status  status = TRB_OK;
  if (PyTuple_Check(object) && !PyArg_ParseTuple(object, "Odddd", &table, &period, &angle_time, &shaft, &outer)) return -1;
  PyArrayObject *motion = trb_array(table, 2, "motion");
  if (motion == NULL) return -1;
  if (PyArray_DIM(motion, 1) != TRB_MOTION_COLUMNS)
    status = trb_fail(&message, TRB_ERR_INPUT, "motion: %d columns needed, %d given", TRB_MOTION_COLUMNS, (int)PyArray_DIM(motion, 1));
  else status = trb_motion_create(PyArray_DATA(motion), (int)PyArray_DIM(motion, 0), to, &message);
  if (status == TRB_OK && period != 0.0) status = trb_motion_repeat(*to, period, &message);
  if (status == TRB_OK && isfinite(angle_time)) trb_motion_set_angles(*to, angle_time, shaft, outer);
  Py_DECREF((PyObject *)motion);
  if (status == TRB_OK) return 0;
  (void)trb_raise(status, &message);
  return -1;
}

/* Models and motions of the bearings out of two tuples of the same length. */
static int read_bearings(simulation_object *self, PyObject *motions, const trb_system **systems)
{
  const Py_ssize_t n = PyTuple_Size(self->models);
  if (n < 1 || n > TRB_MOST_MEMBERS || PyTuple_Size(motions) != n) {
    PyErr_Format(PyExc_ValueError, "models: from 1 to %d, and as many motions; %d and %d given", TRB_MOST_MEMBERS, (int)n,
                 (int)PyTuple_Size(motions));
    return -1;
  }
  for (Py_ssize_t k = 0; k < n; k++) {
    PyObject *model = PyTuple_GetItem(self->models, k);
    if (!PyObject_TypeCheck(model, trb_model_type)) {
      PyErr_SetString(PyExc_TypeError, "models: a tuple of Model");
      return -1;
    }
    systems[k] = ((model_object *)model)->system;
    if (read_motion(PyTuple_GetItem(motions, k), &self->motions[k]) != 0) return -1;
  }
  return 0;
}

static PyObject *simulation_new(PyTypeObject *type, PyObject *args, PyObject *keywords)
{
  static char      *names[] = {"models", "motions", "time", "state", "settings", NULL};
  PyObject         *models, *motions, *state_object, *settings_object;
  const trb_system *systems[TRB_MOST_MEMBERS];
  double            time;
  trb_settings      settings;
  const char       *kind;
  trb_message       message = {TRB_OK, ""};
  if (!PyArg_ParseTupleAndKeywords(args, keywords, "O!O!dOO!", names, &PyTuple_Type, &models, &PyTuple_Type, &motions, &time, &state_object,
                                   &PyDict_Type, &settings_object))
    return NULL;
  if (read_settings(settings_object, &settings, &kind) != 0) return NULL;
  PyArrayObject *state = trb_array(state_object, 1, "state");
  if (state == NULL) return NULL;
  simulation_object *self = (simulation_object *)PyType_GenericAlloc(type, 0);
  if (self != NULL) {
    Py_INCREF(models);
    self->models = models;
    self->inside = PyThread_allocate_lock();
    if (self->inside == NULL) {
      (void)PyErr_NoMemory();
      Py_CLEAR(self);
    }
  }
  if (self != NULL && read_bearings(self, motions, systems) != 0) Py_CLEAR(self);
  if (self != NULL) {
    const trb_motion *const *prescribed = (const trb_motion *const *)self->motions;
    const char              *variant = ((model_object *)PyTuple_GetItem(models, 0))->variant;
    const trb_status         status = trb_simulation_create(systems, prescribed, (int)PyTuple_Size(models), kind, variant, &settings, time,
                                                            PyArray_DATA(state), (int)PyArray_DIM(state, 0), &self->simulation, &message);
    if (status != TRB_OK) {
      (void)trb_raise(status, &message);
      Py_CLEAR(self);
    }
  }
  Py_DECREF((PyObject *)state);
  return (PyObject *)self;
}

static void simulation_dealloc(PyObject *object)
{
  simulation_object *self = (simulation_object *)object;
  trb_simulation_free(self->simulation);
  for (int k = 0; k < TRB_MOST_MEMBERS; k++) trb_motion_free(self->motions[k]);
  if (self->inside != NULL) PyThread_free_lock(self->inside);
  Py_XDECREF(self->models);
  trb_release(object);
}

static PyObject *run(PyObject *object, PyObject *args)
{
  simulation_object *self = (simulation_object *)object;
  PyObject          *times_object;
  PyArrayObject     *records;
  long               max_steps, steps = 0;
  double             stop_after = Py_HUGE_VAL;
  int                rows = 0, beside = 0;
  trb_status         status;
  trb_message        message = {TRB_OK, ""};
  if (!PyArg_ParseTuple(args, "OO!l|dp", &times_object, &PyArray_Type, &records, &max_steps, &stop_after, &beside)) return NULL;
  PyArrayObject *times = trb_array(times_object, 1, "times");
  if (times == NULL) return NULL;
  const int length = trb_simulation_row(self->simulation);
  if (PyArray_TYPE(records) != NPY_DOUBLE || PyArray_NDIM(records) != 2 || !PyArray_IS_C_CONTIGUOUS(records) ||
      !PyArray_ISWRITEABLE(records) || PyArray_DIM(records, 0) < PyArray_DIM(times, 0) || PyArray_DIM(records, 1) != length) {
    PyErr_Format(PyExc_ValueError, "records: must be a writable C-contiguous float64 array with a row of %d a time", length);
    Py_DECREF((PyObject *)times);
    return NULL;
  }
  if (trb_python_enter(self, 1) != 0) {
    Py_DECREF((PyObject *)times);
    return NULL;
  }
  Py_INCREF((PyObject *)records);
  Py_BEGIN_ALLOW_THREADS
  status = trb_simulation_run(self->simulation, PyArray_DATA(times), (int)PyArray_DIM(times, 0), stop_after, PyArray_DATA(records),
                              max_steps, beside, &rows, &steps, &message);
  Py_END_ALLOW_THREADS
  trb_python_leave(self, 1);
  Py_DECREF((PyObject *)records);
  Py_DECREF((PyObject *)times);
  if (status == TRB_OK) return Py_BuildValue("(il)", rows, steps);
  (void)trb_raise(status, &message);
  if (status == TRB_ERR_STEP) {
    /* what was filled stays: the exception says how much */
    PyObject *type, *value, *traceback;
    PyErr_Fetch(&type, &value, &traceback);
    PyErr_NormalizeException(&type, &value, &traceback);
    PyObject *done = PyLong_FromLong(rows), *time = PyFloat_FromDouble(self->simulation->integrator.time);
    if (done != NULL && time != NULL) {
      (void)PyObject_SetAttrString(value, "rows", done);
      (void)PyObject_SetAttrString(value, "time", time);
    }
    Py_XDECREF(done);
    Py_XDECREF(time);
    PyErr_Restore(type, value, traceback);
  }
  return NULL;
}

static PyObject *step(PyObject *object, PyObject *none)
{
  simulation_object *self = (simulation_object *)object;
  trb_message        message = {TRB_OK, ""};
  trb_status         status;
  (void)none;
  if (trb_python_enter(self, 1) != 0) return NULL;
  Py_BEGIN_ALLOW_THREADS
  status = trb_simulation_step(self->simulation, &message);
  Py_END_ALLOW_THREADS
  trb_python_leave(self, 1);
  return status == TRB_OK ? PyFloat_FromDouble(self->simulation->integrator.time) : trb_raise(status, &message);
}

static PyObject *set_state(PyObject *object, PyObject *args)
{
  simulation_object *self = (simulation_object *)object;
  double             time;
  PyObject          *values;
  trb_message        message = {TRB_OK, ""};
  if (!PyArg_ParseTuple(args, "dO", &time, &values)) return NULL;
  PyArrayObject *array = trb_python_state_array(self, values);
  if (array == NULL) return NULL;
  if (trb_python_enter(self, 0) != 0) {
    Py_DECREF((PyObject *)array);
    return NULL;
  }
  const trb_status status = trb_simulation_set_state(self->simulation, time, PyArray_DATA(array), &message);
  Py_DECREF((PyObject *)array);
  return trb_python_done(self, 0, status, &message);
}

static PyObject *restart(PyObject *object, PyObject *none)
{
  simulation_object *self = (simulation_object *)object;
  trb_integrator    *it = &self->simulation->integrator;
  trb_message        message = {TRB_OK, ""};
  (void)none;
  if (trb_python_enter(self, 0) != 0) return NULL;
  return trb_python_done(self, 0, trb_simulation_set_state(self->simulation, it->time, it->y, &message), &message);
}

static PyObject *get_time(PyObject *object, void *closure)
{
  (void)closure;
  return PyFloat_FromDouble(((simulation_object *)object)->simulation->integrator.time);
}

static PyObject *get_row_length(PyObject *object, void *closure)
{
  (void)closure;
  return PyLong_FromLong(trb_simulation_row(((simulation_object *)object)->simulation));
}

static PyObject *get_integrator(PyObject *object, void *closure)
{
  (void)closure;
  return PyUnicode_FromString(((simulation_object *)object)->simulation->integrator.kind->name);
}

static PyObject *get_reason(PyObject *object, void *closure)
{
  const char *reason = ((simulation_object *)object)->simulation->integrator.reason;
  (void)closure;
  return PyUnicode_FromString(reason == NULL ? "" : reason);
}

static PyMethodDef methods[] = {
    {"run", run, METH_VARARGS,
     "run(times, records, max_steps, stop_after=inf): integrate and write one row for each time; gives (rows, steps)."},
    {"step", step, METH_NOARGS, "One step of the integrator; gives the new time."},
    {"state", trb_python_state, METH_NOARGS, "A copy of the state."},
    {"state_at", trb_python_state_at, METH_O, "state_at(time): the state at an instant of the last step."},
    {"begin_peaks", trb_python_begin_peaks, METH_O, "begin_peaks(time): keep peaks from an instant of the last step on."},
    {"end_peaks", trb_python_end_peaks, METH_NOARGS, "Keep no more peaks."},
    {"save_peaks", trb_python_save_peaks, METH_NOARGS, "All that restore_peaks needs; empty if no peaks are kept."},
    {"restore_peaks", trb_python_restore_peaks, METH_O, "restore_peaks(saved): go on with peaks that were saved at this time."},
    {"whole_peaks", trb_python_whole_peaks, METH_O,
     "whole_peaks(time): rows of peaks, bearing by bearing, from their beginning to an instant of the last step."},
    {"set_state", set_state, METH_VARARGS, "set_state(time, state): restart the integrator there."},
    {"restart", restart, METH_NOARGS, "Restart the integrator where it is."},
    {"observe", trb_python_observe, METH_VARARGS, "observe(time, state): a record of each bearing, one after the other."},
    {"derivative", trb_python_derivative, METH_VARARGS, "derivative(time, state): rates of the state."},
    {"contacts", trb_python_contacts, METH_VARARGS,
     "contacts(time, state, bearing=0): every intermediate quantity of every contact of a bearing."},
    {"counters", trb_python_counters, METH_NOARGS, "What was evaluated, counted."},
    {"statistics", trb_python_statistics, METH_NOARGS, "What the integrator did."},
    {NULL, NULL, 0, NULL},
};

static PyGetSetDef properties[] = {
    {"time", get_time, NULL, "end of the last step, s", NULL},
    {"integrator", get_integrator, NULL, "name of the integrator that is used", NULL},
    {"reason", get_reason, NULL, "why that is not the first choice, where none was asked for; or empty", NULL},
    {"row_length", get_row_length, NULL, "length of a row of records, with its peaks if they are kept", NULL},
    {NULL, NULL, NULL, NULL, NULL},
};

static PyType_Slot slots[] = {
    {Py_tp_dealloc, simulation_dealloc},
    {Py_tp_doc, "One integration: bearings with what is prescribed for each, state, integrator."},
    {Py_tp_methods, methods},
    {Py_tp_getset, properties},
    {Py_tp_new, simulation_new},
    {0, NULL},
};

PyType_Spec trb_simulation_spec = {
    .name = "trbdyn._core.Simulation",
    .basicsize = sizeof(simulation_object),
    .flags = Py_TPFLAGS_DEFAULT | Py_TPFLAGS_IMMUTABLETYPE,
    .slots = slots,
};
