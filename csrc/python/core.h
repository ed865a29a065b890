/* What the files of the extension module share. Python.h is included here and nowhere outside python/. */
#ifndef TRB_PYTHON_CORE_H
#define TRB_PYTHON_CORE_H

#define PY_SSIZE_T_CLEAN
#include <Python.h>
#ifdef Py_GIL_DISABLED
#error "trbdyn needs the global interpreter lock: free-threaded builds of Python are not supported"
#endif
#ifndef TRB_PYTHON_MAIN
#define NO_IMPORT_ARRAY
#endif
#define PY_ARRAY_UNIQUE_SYMBOL trb_numpy
#include <numpy/arrayobject.h>

#include "bearing/model.h"
#include "base/status.h"
#include "system/tapered.h"

typedef struct model_object {
  PyObject_HEAD
  trb_model  *model;
  trb_system *system;      /* of the model */
  char        variant[16]; /* kernel variant in use */
} model_object;

/* Types are made when the module is first loaded, from their specifications: with the stable ABI there are no static ones. */
extern PyTypeObject *trb_model_type, *trb_simulation_type;
extern PyType_Spec   trb_model_spec, trb_simulation_spec;

/* Memory of an object and its type's reference, given back. */
void trb_release(PyObject *object);

/* Raise the exception of a status; NULL, so that callers can write: return raise_status(...). */
PyObject        *trb_raise(trb_status status, const trb_message *message);
extern PyObject *trb_step_error;

/* A C-contiguous float64 array with ndim dimensions (new reference); NULL with an error that names it. */
PyArrayObject *trb_array(PyObject *object, int ndim, const char *name);
/* A new float64 vector with a copy of values (which may be NULL: zeros). */
PyObject *trb_vector(const double *values, npy_intp n);
/* A new float64 matrix with a copy of values (which may be NULL: not set). */
PyObject *trb_matrix(const double *values, npy_intp rows, npy_intp width);
/* Put a new reference under a key and give it up; -1 on error. */
int trb_put(PyObject *dictionary, const char *key, PyObject *value);
/* Function of the module: length of the state of bearings that are simulated together, and the layout of each one's part. */
PyObject *trb_python_state_layouts(PyObject *module, PyObject *models);
/* Put everything that is known of the contacts at a state into a dictionary, by name; -1 on error. */
int trb_put_contacts(const trb_system *system, const trb_detail *detail, const trb_loads *loads, const trb_loads *hub, PyObject *out);

#endif
