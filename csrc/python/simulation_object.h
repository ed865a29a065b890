/* The Python object of a simulation: what its files share. */
#ifndef TRB_PYTHON_SIMULATION_OBJECT_H
#define TRB_PYTHON_SIMULATION_OBJECT_H

#include "python/core.h"
#include "stepping/simulation.h"

typedef struct simulation_object {
  PyObject_HEAD
  PyObject          *models;                    /* a tuple that keeps the bearings' models alive */
  trb_motion        *motions[TRB_MOST_MEMBERS]; /* what is prescribed for each */
  trb_simulation    *simulation;
  PyThread_type_lock inside;   /* held by the one thread that uses it */
  int                stepping; /* that thread is in the integrator, or is about to be */
} simulation_object;

/* A state of the simulation's length (new reference); NULL with an error. */
PyArrayObject *trb_python_state_array(const simulation_object *self, PyObject *object);

/* From enter to leave the calling thread is alone in a simulation; -1 with an error if another one steps. stepping: it steps, too. */
int  trb_python_enter(simulation_object *self, int stepping);
void trb_python_leave(simulation_object *self, int stepping);

/* The same at the end of a call: None, or NULL with the error of a status. */
PyObject *trb_python_done(simulation_object *self, int stepping, trb_status status, const trb_message *message);

/* Methods that look at a simulation (simulation_looks.c). */
PyObject *trb_python_state(PyObject *object, PyObject *none);
PyObject *trb_python_state_at(PyObject *object, PyObject *value);
PyObject *trb_python_observe(PyObject *object, PyObject *args);
PyObject *trb_python_derivative(PyObject *object, PyObject *args);
PyObject *trb_python_contacts(PyObject *object, PyObject *args);
PyObject *trb_python_counters(PyObject *object, PyObject *none);
PyObject *trb_python_statistics(PyObject *object, PyObject *none);

/* Methods that keep peaks (simulation_peaks.c). */
PyObject *trb_python_begin_peaks(PyObject *object, PyObject *value);
PyObject *trb_python_end_peaks(PyObject *object, PyObject *none);
PyObject *trb_python_save_peaks(PyObject *object, PyObject *none);
PyObject *trb_python_restore_peaks(PyObject *object, PyObject *values);
PyObject *trb_python_whole_peaks(PyObject *object, PyObject *value);

#endif
