/* trbdyn._core.Simulation */
#include "python/core.h"

#include <math.h>
#include <string.h>

#include "contact/kernels.h"
#include "stepping/simulation.h"

typedef struct simulation_object {
  PyObject_HEAD
  PyObject          *model; /* keeps the model alive */
  trb_motion        *motion;
  trb_simulation    *simulation;
  PyThread_type_lock inside;   /* held by the one thread that uses it */
  int                stepping; /* that thread is in the integrator, or is about to be */
} simulation_object;

/* Settings by name out of a dict; integrator is the one that is not a number. */
static int read_settings(PyObject *dictionary, trb_settings *settings, const char **kind)
{
  double    *values = (double *)settings;
  PyObject  *key, *value;
  Py_ssize_t position = 0;
  *kind = "bdf";
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

static const trb_model *model_of(const simulation_object *self) { return ((model_object *)self->model)->model; }

static PyArrayObject *state_array(const simulation_object *self, PyObject *object)
{
  PyArrayObject *state = trb_array(object, 1, "state");
  if (state != NULL && PyArray_DIM(state, 0) != trb_state_size(model_of(self))) {
    PyErr_Format(PyExc_ValueError, "state: %d values needed, %d given", trb_state_size(model_of(self)), (int)PyArray_DIM(state, 0));
    Py_CLEAR(state);
  }
  return state;
}

static PyObject *simulation_new(PyTypeObject *type, PyObject *args, PyObject *keywords)
{
  static char *names[] = {"model", "motion", "time", "state", "settings", "period", "angle_time", "angle", NULL};
  PyObject    *model, *motion_object, *state_object, *settings_object;
  double       time, period = 0.0, angle_time = NAN, angle = 0.0;
  trb_settings settings;
  const char  *kind;
  trb_message  message = {TRB_OK, ""};
  if (!PyArg_ParseTupleAndKeywords(args, keywords, "O!OdOO!|ddd", names, trb_model_type, &model, &motion_object, &time, &state_object,
                                   &PyDict_Type, &settings_object, &period, &angle_time, &angle))
    return NULL;
  if (read_settings(settings_object, &settings, &kind) != 0) return NULL;
  PyArrayObject *motion = trb_array(motion_object, 2, "motion");
  if (motion == NULL) return NULL;
  simulation_object *self = (simulation_object *)PyType_GenericAlloc(type, 0);
  PyArrayObject     *state = NULL;
  if (self != NULL) {
    Py_INCREF(model);
    self->model = model;
    self->inside = PyThread_allocate_lock();
    state = self->inside != NULL ? state_array(self, state_object) : (PyArrayObject *)PyErr_NoMemory();
  }
  if (state != NULL) {
    trb_status status = TRB_OK;
    if (PyArray_DIM(motion, 1) != TRB_MOTION_COLUMNS)
      status = trb_fail(&message, TRB_ERR_INPUT, "motion: %d columns needed, %d given", TRB_MOTION_COLUMNS, (int)PyArray_DIM(motion, 1));
    else status = trb_motion_create(PyArray_DATA(motion), (int)PyArray_DIM(motion, 0), &self->motion, &message);
    if (status == TRB_OK && period != 0.0) status = trb_motion_repeat(self->motion, period, &message);
    if (status == TRB_OK && isfinite(angle_time)) trb_motion_set_angle(self->motion, angle_time, angle);
    if (status == TRB_OK)
      status = trb_simulation_create(model_of(self), self->motion, kind, ((model_object *)model)->variant, &settings, time,
                                     PyArray_DATA(state), &self->simulation, &message);
    if (status != TRB_OK) {
      (void)trb_raise(status, &message);
      Py_CLEAR(self);
    }
    Py_DECREF((PyObject *)state);
  } else {
    Py_CLEAR(self);
  }
  Py_DECREF((PyObject *)motion);
  return (PyObject *)self;
}

static void simulation_dealloc(PyObject *object)
{
  simulation_object *self = (simulation_object *)object;
  trb_simulation_free(self->simulation);
  trb_motion_free(self->motion);
  if (self->inside != NULL) PyThread_free_lock(self->inside);
  Py_XDECREF(self->model);
  trb_release(object);
}

/* Longest wait for another thread's look, ms. */
#define TRB_LOOK_WAIT 1000

static int try_lock(simulation_object *self, PY_TIMEOUT_T microseconds)
{
  return PyThread_acquire_lock_timed(self->inside, microseconds, 0) == PY_LOCK_ACQUIRED;
}

/* The calling thread is alone in here. One that steps is not waited for; a look lets others in where NumPy allocates, and is over soon. */
static int enter(simulation_object *self, int stepping)
{
  int got = try_lock(self, 0);
  if (!got && !self->stepping) {
    self->stepping = stepping; /* from now on others are refused, so that they cannot keep this one waiting */
    for (int i = 0; i < TRB_LOOK_WAIT && !got && self->stepping == stepping; i++) {
      Py_BEGIN_ALLOW_THREADS
      got = try_lock(self, 1000);
      Py_END_ALLOW_THREADS
    }
    if (!got && stepping) self->stepping = 0;
  }
  if (!got) {
    PyErr_SetString(PyExc_RuntimeError, "this simulation is stepping in another thread; give each thread its own");
    return -1;
  }
  if (stepping) self->stepping = 1;
  return 0;
}

static void leave(simulation_object *self, int stepping)
{
  if (stepping) self->stepping = 0;
  PyThread_release_lock(self->inside);
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
  if (enter(self, 1) != 0) {
    Py_DECREF((PyObject *)times);
    return NULL;
  }
  Py_INCREF((PyObject *)records);
  Py_BEGIN_ALLOW_THREADS
  status = trb_simulation_run(self->simulation, PyArray_DATA(times), (int)PyArray_DIM(times, 0), stop_after, PyArray_DATA(records),
                              max_steps, beside, &rows, &steps, &message);
  Py_END_ALLOW_THREADS
  leave(self, 1);
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
  if (enter(self, 1) != 0) return NULL;
  Py_BEGIN_ALLOW_THREADS
  status = trb_simulation_step(self->simulation, &message);
  Py_END_ALLOW_THREADS
  leave(self, 1);
  return status == TRB_OK ? PyFloat_FromDouble(self->simulation->integrator.time) : trb_raise(status, &message);
}

static PyObject *state(PyObject *object, PyObject *none)
{
  simulation_object    *self = (simulation_object *)object;
  const trb_integrator *it = &self->simulation->integrator;
  (void)none;
  if (enter(self, 0) != 0) return NULL; /* it would be half of one step and half of another */
  PyObject *out = trb_vector(it->y, it->n);
  leave(self, 0);
  return out;
}

static PyObject *set_state(PyObject *object, PyObject *args)
{
  simulation_object *self = (simulation_object *)object;
  double             time;
  PyObject          *values;
  trb_message        message = {TRB_OK, ""};
  if (!PyArg_ParseTuple(args, "dO", &time, &values)) return NULL;
  PyArrayObject *array = state_array(self, values);
  if (array == NULL) return NULL;
  if (enter(self, 0) != 0) {
    Py_DECREF((PyObject *)array);
    return NULL;
  }
  const trb_status status = trb_simulation_set_state(self->simulation, time, PyArray_DATA(array), &message);
  leave(self, 0);
  Py_DECREF((PyObject *)array);
  if (status != TRB_OK) return trb_raise(status, &message);
  Py_RETURN_NONE;
}

static PyObject *restart(PyObject *object, PyObject *none)
{
  simulation_object *self = (simulation_object *)object;
  trb_integrator    *it = &self->simulation->integrator;
  trb_message        message = {TRB_OK, ""};
  (void)none;
  if (enter(self, 0) != 0) return NULL;
  const trb_status status = trb_simulation_set_state(self->simulation, it->time, it->y, &message);
  leave(self, 0);
  if (status != TRB_OK) return trb_raise(status, &message);
  Py_RETURN_NONE;
}

/* Time and state that a user asks about; the state is a new reference. */
static PyArrayObject *look(simulation_object *self, PyObject *args, double *time)
{
  PyObject *values;
  if (!PyArg_ParseTuple(args, "dO", time, &values)) return NULL;
  PyArrayObject *array = state_array(self, values);
  if (array != NULL && enter(self, 0) != 0) Py_CLEAR(array);
  return array;
}

static PyObject *observe(PyObject *object, PyObject *args)
{
  simulation_object *self = (simulation_object *)object;
  trb_simulation    *s = self->simulation;
  double             time;
  PyArrayObject     *array = look(self, args, &time);
  if (array == NULL) return NULL;
  PyObject *out = trb_vector(NULL, trb_record_offset(s->model, TRB_N_FIELDS));
  if (out != NULL) trb_record_fill(s->onlooker, NULL, time, PyArray_DATA(array), s->detail, PyArray_DATA((PyArrayObject *)out));
  leave(self, 0);
  Py_DECREF((PyObject *)array);
  return out;
}

static PyObject *derivative(PyObject *object, PyObject *args)
{
  simulation_object *self = (simulation_object *)object;
  trb_simulation    *s = self->simulation;
  double             time;
  PyArrayObject     *array = look(self, args, &time);
  if (array == NULL) return NULL;
  PyObject *out = trb_vector(NULL, s->integrator.n);
  if (out != NULL) trb_rhs(s->onlooker, NULL, time, PyArray_DATA(array), PyArray_DATA((PyArrayObject *)out));
  leave(self, 0);
  Py_DECREF((PyObject *)array);
  return out;
}

static PyObject *contacts(PyObject *object, PyObject *args)
{
  simulation_object *self = (simulation_object *)object;
  trb_simulation    *s = self->simulation;
  double             time;
  PyArrayObject     *array = look(self, args, &time);
  if (array == NULL) return NULL;
  trb_dynamics_pose(s->onlooker, time, PyArray_DATA(array));
  trb_detail_clear(s->model, s->detail);
  trb_dynamics_loads(s->onlooker, s->detail);
  PyObject *out = PyDict_New();
  if (out != NULL && trb_put_contacts(s->model, s->detail, s->onlooker->loads, &s->onlooker->hub, out) != 0) Py_CLEAR(out);
  leave(self, 0);
  Py_DECREF((PyObject *)array);
  return out;
}

static PyObject *counters(PyObject *object, PyObject *none)
{
  simulation_object  *self = (simulation_object *)object;
  const trb_counters *c = &self->simulation->dynamics->work->counters;
  (void)none;
  if (enter(self, 0) != 0) return NULL;
  PyObject *out = PyDict_New();
#define PUT(name, text) \
  if (out != NULL && trb_put(out, #name, PyLong_FromLongLong(c->name)) != 0) Py_CLEAR(out);
  TRB_COUNTERS(PUT)
#undef PUT
  leave(self, 0);
  return out;
}

static PyObject *statistics(PyObject *object, PyObject *none)
{
  simulation_object    *self = (simulation_object *)object;
  const trb_integrator *it = &self->simulation->integrator;
  trb_statistics        s = {0};
  (void)none;
  if (enter(self, 0) != 0) return NULL;
  PyObject *out = PyDict_New();
  it->kind->statistics(it, &s);
#define PUT(name, text) \
  if (out != NULL && trb_put(out, #name, PyFloat_FromDouble(s.name)) != 0) Py_CLEAR(out);
  TRB_STATISTICS(PUT)
#undef PUT
  leave(self, 0);
  return out;
}

static PyObject *state_at(PyObject *object, PyObject *value)
{
  simulation_object *self = (simulation_object *)object;
  const double       time = PyFloat_AsDouble(value);
  trb_message        message = {TRB_OK, ""};
  trb_status         status = TRB_OK;
  if ((time == -1.0 && PyErr_Occurred()) || enter(self, 0) != 0) return NULL;
  PyObject *out = trb_vector(NULL, self->simulation->integrator.n);
  if (out != NULL) status = trb_simulation_state_at(self->simulation, time, PyArray_DATA((PyArrayObject *)out), &message);
  leave(self, 0);
  if (status == TRB_OK) return out;
  Py_DECREF(out);
  return trb_raise(status, &message);
}

static PyObject *begin_peaks(PyObject *object, PyObject *value)
{
  simulation_object *self = (simulation_object *)object;
  const double       time = PyFloat_AsDouble(value);
  trb_message        message = {TRB_OK, ""};
  if ((time == -1.0 && PyErr_Occurred()) || enter(self, 0) != 0) return NULL;
  const trb_status status = trb_simulation_begin_peaks(self->simulation, time, &message);
  leave(self, 0);
  if (status != TRB_OK) return trb_raise(status, &message);
  Py_RETURN_NONE;
}

static PyObject *end_peaks(PyObject *object, PyObject *none)
{
  simulation_object *self = (simulation_object *)object;
  (void)none;
  if (enter(self, 0) != 0) return NULL;
  trb_simulation_end_peaks(self->simulation);
  leave(self, 0);
  Py_RETURN_NONE;
}

static PyObject *save_peaks(PyObject *object, PyObject *none)
{
  simulation_object *self = (simulation_object *)object;
  (void)none;
  if (enter(self, 0) != 0) return NULL;
  const trb_peaks *peaks = self->simulation->peaks;
  PyObject        *out = trb_vector(NULL, peaks != NULL ? trb_peaks_length(peaks) : 0);
  if (out != NULL && peaks != NULL) trb_peaks_save(peaks, PyArray_DATA((PyArrayObject *)out));
  leave(self, 0);
  return out;
}

static PyObject *restore_peaks(PyObject *object, PyObject *values)
{
  simulation_object *self = (simulation_object *)object;
  trb_message        message = {TRB_OK, ""};
  PyArrayObject     *array = trb_array(values, 1, "peaks");
  if (array == NULL || enter(self, 0) != 0) {
    Py_XDECREF((PyObject *)array);
    return NULL;
  }
  const trb_status status = trb_simulation_restore_peaks(self->simulation, PyArray_DATA(array), (int)PyArray_DIM(array, 0), &message);
  leave(self, 0);
  Py_DECREF((PyObject *)array);
  if (status != TRB_OK) return trb_raise(status, &message);
  Py_RETURN_NONE;
}

static PyObject *whole_peaks(PyObject *object, PyObject *value)
{
  simulation_object *self = (simulation_object *)object;
  const double       time = PyFloat_AsDouble(value);
  if ((time == -1.0 && PyErr_Occurred()) || enter(self, 0) != 0) return NULL;
  const trb_peaks *peaks = self->simulation->peaks;
  PyObject        *out = trb_vector(NULL, peaks != NULL ? trb_peak_offset(model_of(self), TRB_N_PEAK_FIELDS) : 0);
  if (out != NULL && peaks != NULL) trb_peaks_whole(peaks, time, PyArray_DATA((PyArrayObject *)out));
  leave(self, 0);
  return out;
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

static PyMethodDef methods[] = {
    {"run", run, METH_VARARGS,
     "run(times, records, max_steps, stop_after=inf): integrate and write one row for each time; gives (rows, steps)."},
    {"step", step, METH_NOARGS, "One step of the integrator; gives the new time."},
    {"state", state, METH_NOARGS, "A copy of the state."},
    {"state_at", state_at, METH_O, "state_at(time): the state at an instant of the last step."},
    {"begin_peaks", begin_peaks, METH_O, "begin_peaks(time): keep peaks from an instant of the last step on."},
    {"end_peaks", end_peaks, METH_NOARGS, "Keep no more peaks."},
    {"save_peaks", save_peaks, METH_NOARGS, "All that restore_peaks needs; empty if no peaks are kept."},
    {"restore_peaks", restore_peaks, METH_O, "restore_peaks(saved): go on with peaks that were saved at this time."},
    {"whole_peaks", whole_peaks, METH_O, "whole_peaks(time): a row of peaks from their beginning to an instant of the last step."},
    {"set_state", set_state, METH_VARARGS, "set_state(time, state): restart the integrator there."},
    {"restart", restart, METH_NOARGS, "Restart the integrator where it is."},
    {"observe", observe, METH_VARARGS, "observe(time, state): a record."},
    {"derivative", derivative, METH_VARARGS, "derivative(time, state): rates of the state."},
    {"contacts", contacts, METH_VARARGS, "contacts(time, state): every intermediate quantity of every contact."},
    {"counters", counters, METH_NOARGS, "What was evaluated, counted."},
    {"statistics", statistics, METH_NOARGS, "What the integrator did."},
    {NULL, NULL, 0, NULL},
};

static PyGetSetDef properties[] = {
    {"time", get_time, NULL, "end of the last step, s", NULL},
    {"row_length", get_row_length, NULL, "length of a row of records, with its peaks if they are kept", NULL},
    {NULL, NULL, NULL, NULL, NULL},
};

static PyType_Slot slots[] = {
    {Py_tp_dealloc, simulation_dealloc},
    {Py_tp_doc, "One integration: model, prescribed motion, state, integrator."},
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
