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
  int length = 0;
  for (int k = 0; k < s->assembly.n; k++) length += trb_record_offset(&s->assembly.members[k], TRB_N_FIELDS);
  PyObject *out = trb_vector(NULL, length);
  double   *row = out != NULL ? PyArray_DATA((PyArrayObject *)out) : NULL;
  for (int k = 0; k < s->assembly.n && row != NULL; k++) {
    trb_record_fill(s->parts[k].onlooker, NULL, time, PyArray_DATA(array), s->parts[k].detail, row);
    row += trb_record_offset(&s->assembly.members[k], TRB_N_FIELDS);
  }
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
  for (int k = 0; k < s->assembly.n && out != NULL; k++)
    trb_rhs(s->parts[k].onlooker, NULL, time, PyArray_DATA(array), PyArray_DATA((PyArrayObject *)out));
  trb_python_leave(self, 0);
  Py_DECREF((PyObject *)array);
  return out;
}

PyObject *trb_python_contacts(PyObject *object, PyObject *args)
{
  simulation_object *self = (simulation_object *)object;
  trb_simulation    *s = self->simulation;
  double             time;
  PyObject          *values;
  int                k = 0;
  if (!PyArg_ParseTuple(args, "dO|i", &time, &values, &k)) return NULL;
  if (k < 0 || k >= s->assembly.n) return PyErr_Format(PyExc_ValueError, "bearing: must be from 0 to %d, not %d", s->assembly.n - 1, k);
  PyArrayObject *array = trb_python_state_array(self, values);
  if (array != NULL && trb_python_enter(self, 0) != 0) Py_CLEAR(array);
  if (array == NULL) return NULL;
  trb_dynamics *onlooker = s->parts[k].onlooker;
  trb_dynamics_pose(onlooker, time, PyArray_DATA(array));
  trb_detail_clear(onlooker->model, s->parts[k].detail);
  trb_dynamics_loads(onlooker, NULL, s->parts[k].detail);
  PyObject *out = PyDict_New();
  if (out != NULL && trb_put_contacts(onlooker->system, s->parts[k].detail, onlooker->loads, &onlooker->hub, out) != 0) Py_CLEAR(out);
  trb_python_leave(self, 0);
  Py_DECREF((PyObject *)array);
  return out;
}

PyObject *trb_python_counters(PyObject *object, PyObject *none)
{
  simulation_object *self = (simulation_object *)object;
  trb_simulation    *s = self->simulation;
  trb_counters       sum = {0};
  (void)none;
  if (trb_python_enter(self, 0) != 0) return NULL;
  PyObject *out = PyDict_New();
#define ADD(name, text) sum.name += s->integrator.members[k].dynamics->work->counters.name;
  for (int k = 0; k < s->assembly.n; k++) {
    TRB_COUNTERS(ADD)
  }
#undef ADD
#define PUT(name, text) \
  if (out != NULL && trb_put(out, #name, PyLong_FromLongLong(sum.name)) != 0) Py_CLEAR(out);
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
