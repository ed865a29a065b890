/* What a user sees of a simulation: its state, a record, rates and contacts at any state, counts. */
#include "python/simulation_object.h"

#include "contact/kernels.h"

PyObject *trb_python_state(PyObject *object, PyObject *none)
{
  simulation_object    *self = (simulation_object *)object;
  const trb_integrator *it = &self->simulation->integrator;
  (void)none;
  if (trb_python_enter(self, 0) != 0) return NULL; /* it would be half of one step and half of another */
  PyObject *out = trb_vector(it->y, it->n);
  trb_python_leave(self, 0);
  return out;
}

/* Time and state that a user asks about; the state is a new reference. */
static PyArrayObject *look(simulation_object *self, PyObject *args, double *time)
{
  PyObject *values;
  if (!PyArg_ParseTuple(args, "dO", time, &values)) return NULL;
  PyArrayObject *array = trb_python_state_array(self, values);
  if (array != NULL && trb_python_enter(self, 0) != 0) Py_CLEAR(array);
  return array;
}

PyObject *trb_python_observe(PyObject *object, PyObject *args)
{
  simulation_object *self = (simulation_object *)object;
  trb_simulation    *s = self->simulation;
  double             time;
  PyArrayObject     *array = look(self, args, &time);
  if (array == NULL) return NULL;
  PyObject *out = trb_vector(NULL, trb_record_offset(s->model, TRB_N_FIELDS));
  if (out != NULL) trb_record_fill(s->onlooker, NULL, time, PyArray_DATA(array), s->detail, PyArray_DATA((PyArrayObject *)out));
  trb_python_leave(self, 0);
  Py_DECREF((PyObject *)array);
  return out;
}

PyObject *trb_python_derivative(PyObject *object, PyObject *args)
{
  simulation_object *self = (simulation_object *)object;
  trb_simulation    *s = self->simulation;
  double             time;
  PyArrayObject     *array = look(self, args, &time);
  if (array == NULL) return NULL;
  PyObject *out = trb_vector(NULL, s->integrator.n);
  if (out != NULL) trb_rhs(s->onlooker, NULL, time, PyArray_DATA(array), PyArray_DATA((PyArrayObject *)out));
  trb_python_leave(self, 0);
  Py_DECREF((PyObject *)array);
  return out;
}

PyObject *trb_python_contacts(PyObject *object, PyObject *args)
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
  if (out != NULL && trb_put_contacts(s->system, s->detail, s->onlooker->loads, &s->onlooker->hub, out) != 0) Py_CLEAR(out);
  trb_python_leave(self, 0);
  Py_DECREF((PyObject *)array);
  return out;
}

PyObject *trb_python_counters(PyObject *object, PyObject *none)
{
  simulation_object  *self = (simulation_object *)object;
  const trb_counters *c = &self->simulation->dynamics->work->counters;
  (void)none;
  if (trb_python_enter(self, 0) != 0) return NULL;
  PyObject *out = PyDict_New();
#define PUT(name, text) \
  if (out != NULL && trb_put(out, #name, PyLong_FromLongLong(c->name)) != 0) Py_CLEAR(out);
  TRB_COUNTERS(PUT)
#undef PUT
  trb_python_leave(self, 0);
  return out;
}

PyObject *trb_python_statistics(PyObject *object, PyObject *none)
{
  simulation_object    *self = (simulation_object *)object;
  const trb_integrator *it = &self->simulation->integrator;
  trb_statistics        s = {0};
  (void)none;
  if (trb_python_enter(self, 0) != 0) return NULL;
  PyObject *out = PyDict_New();
  it->kind->statistics(it, &s);
#define PUT(name, text) \
  if (out != NULL && trb_put(out, #name, PyFloat_FromDouble(s.name)) != 0) Py_CLEAR(out);
  TRB_STATISTICS(PUT)
#undef PUT
  trb_python_leave(self, 0);
  return out;
}

PyObject *trb_python_state_at(PyObject *object, PyObject *value)
{
  simulation_object *self = (simulation_object *)object;
  const double       time = PyFloat_AsDouble(value);
  trb_message        message = {TRB_OK, ""};
  trb_status         status = TRB_OK;
  if ((time == -1.0 && PyErr_Occurred()) || trb_python_enter(self, 0) != 0) return NULL;
  PyObject *out = trb_vector(NULL, self->simulation->integrator.n);
  if (out != NULL) status = trb_simulation_state_at(self->simulation, time, PyArray_DATA((PyArrayObject *)out), &message);
  trb_python_leave(self, 0);
  if (status == TRB_OK) return out;
  Py_DECREF(out);
  return trb_raise(status, &message);
}
