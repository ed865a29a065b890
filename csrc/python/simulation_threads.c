/* One thread at a time in a simulation: Python lets others run while one steps. */
#include "python/simulation_object.h"

/* Longest wait for another thread's look, ms. */
#define TRB_LOOK_WAIT 1000

static int try_lock(simulation_object *self, PY_TIMEOUT_T microseconds)
{
  return PyThread_acquire_lock_timed(self->inside, microseconds, 0) == PY_LOCK_ACQUIRED;
}

/* The calling thread is alone in here. One that steps is not waited for; a look lets others in where NumPy allocates, and is over soon. */
int trb_python_enter(simulation_object *self, int stepping)
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

void trb_python_leave(simulation_object *self, int stepping)
{
  if (stepping) self->stepping = 0;
  PyThread_release_lock(self->inside);
}

PyObject *trb_python_done(simulation_object *self, int stepping, trb_status status, const trb_message *message)
{
  trb_python_leave(self, stepping);
  if (status != TRB_OK) return trb_raise(status, message);
  Py_RETURN_NONE;
}
