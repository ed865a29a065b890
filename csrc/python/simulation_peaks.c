/* Peaks of a run: begun, saved, restored, read. */
#include "python/simulation_object.h"

PyObject *trb_python_begin_peaks(PyObject *object, PyObject *value)
{
  simulation_object *self = (simulation_object *)object;
  const double       time = PyFloat_AsDouble(value);
  trb_message        message = {TRB_OK, ""};
  if ((time == -1.0 && PyErr_Occurred()) || trb_python_enter(self, 0) != 0) return NULL;
  return trb_python_done(self, 0, trb_simulation_begin_peaks(self->simulation, time, &message), &message);
}

PyObject *trb_python_end_peaks(PyObject *object, PyObject *none)
{
  simulation_object *self = (simulation_object *)object;
  (void)none;
  if (trb_python_enter(self, 0) != 0) return NULL;
  trb_simulation_end_peaks(self->simulation);
  return trb_python_done(self, 0, TRB_OK, NULL);
}

PyObject *trb_python_save_peaks(PyObject *object, PyObject *none)
{
  simulation_object *self = (simulation_object *)object;
  (void)none;
  if (trb_python_enter(self, 0) != 0) return NULL;
  PyObject *out = trb_vector(NULL, trb_simulation_peaks_length(self->simulation));
  if (out != NULL) trb_simulation_save_peaks(self->simulation, PyArray_DATA((PyArrayObject *)out));
  trb_python_leave(self, 0);
  return out;
}

PyObject *trb_python_restore_peaks(PyObject *object, PyObject *values)
{
  simulation_object *self = (simulation_object *)object;
  trb_message        message = {TRB_OK, ""};
  PyArrayObject     *array = trb_array(values, 1, "peaks");
  if (array == NULL || trb_python_enter(self, 0) != 0) {
    Py_XDECREF((PyObject *)array);
    return NULL;
  }
  const trb_status status = trb_simulation_restore_peaks(self->simulation, PyArray_DATA(array), (int)PyArray_DIM(array, 0), &message);
  Py_DECREF((PyObject *)array);
  return trb_python_done(self, 0, status, &message);
}

PyObject *trb_python_whole_peaks(PyObject *object, PyObject *value)
{
  simulation_object *self = (simulation_object *)object;
  const double       time = PyFloat_AsDouble(value);
  if ((time == -1.0 && PyErr_Occurred()) || trb_python_enter(self, 0) != 0) return NULL;
  PyObject *out = trb_vector(NULL, trb_simulation_whole_length(self->simulation));
  if (out != NULL) trb_simulation_whole_peaks(self->simulation, time, PyArray_DATA((PyArrayObject *)out));
  trb_python_leave(self, 0);
  return out;
}
