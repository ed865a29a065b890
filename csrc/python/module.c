/* The extension module: its tables and laws. */
#define TRB_PYTHON_MAIN
#include "python/core.h"

#include <string.h>

#include "contact/kernels.h"
#include "laws/table.h"
#include "motion/peaks.h"
#include "motion/record.h"
#include "stepping/integrator.h"
#include "stepping/sundials_context.h"

static PyObject *trb_error, *trb_input_error, *trb_load_error;
PyObject        *trb_step_error;
PyTypeObject    *trb_model_type, *trb_simulation_type;

void trb_release(PyObject *object)
{
  PyTypeObject *type = Py_TYPE(object);
  freefunc      release = (freefunc)PyType_GetSlot(type, Py_tp_free);
  release(object);
  Py_DECREF((PyObject *)type);
}

PyObject *trb_raise(trb_status status, const trb_message *message)
{
  PyObject *type = trb_error;
  if (status == TRB_ERR_MEMORY) type = PyExc_MemoryError;
  if (status == TRB_ERR_INPUT || status == TRB_ERR_GEOMETRY || status == TRB_ERR_STATE) type = trb_input_error;
  if (status == TRB_ERR_LOAD) type = trb_load_error;
  if (status == TRB_ERR_STEP) type = trb_step_error;
  PyErr_SetString(type, message->text[0] != '\0' ? message->text : trb_status_text(status));
  return NULL;
}

PyArrayObject *trb_array(PyObject *object, int ndim, const char *name)
{
  PyArrayObject *array = (PyArrayObject *)PyArray_FROMANY(object, NPY_DOUBLE, ndim, ndim, NPY_ARRAY_C_CONTIGUOUS | NPY_ARRAY_ALIGNED);
  if (array == NULL && PyErr_ExceptionMatches(PyExc_ValueError)) {
    PyErr_Clear();
    PyErr_Format(trb_input_error, "%s: must be a float64 array of %d dimensions", name, ndim);
  }
  return array;
}

PyObject *trb_vector(const double *values, npy_intp n)
{
  PyObject *array = PyArray_ZEROS(1, &n, NPY_DOUBLE, 0);
  if (array != NULL && values != NULL && n > 0) memcpy(PyArray_DATA((PyArrayObject *)array), values, (size_t)n * sizeof *values);
  return array;
}

PyObject *trb_matrix(const double *values, npy_intp rows, npy_intp width)
{
  npy_intp  shape[2] = {rows, width};
  PyObject *array = PyArray_SimpleNew(2, shape, NPY_DOUBLE);
  if (array != NULL && values != NULL) memcpy(PyArray_DATA((PyArrayObject *)array), values, (size_t)(rows * width) * sizeof *values);
  return array;
}

int trb_put(PyObject *dictionary, const char *key, PyObject *value)
{
  if (value == NULL) return -1;
  const int failed = PyDict_SetItemString(dictionary, key, value);
  Py_DECREF(value);
  return failed;
}

/* Append a new reference to a list and give it up. */
static int append(PyObject *list, PyObject *item)
{
  if (item == NULL) return -1;
  const int failed = PyList_Append(list, item);
  Py_DECREF(item);
  return failed;
}

#define TABLE(function, count, ...) \
  static PyObject *function(PyObject *module, PyObject *none) \
  { \
    (void)module; \
    (void)none; \
    PyObject *list = PyList_New(0); \
    for (int i = 0; list != NULL && i < (count); i++) \
      if (append(list, Py_BuildValue(__VA_ARGS__)) != 0) Py_CLEAR(list); \
    return list; \
  }

static const struct {
  const char *name;
  int         count;
  const char *unit, *text;
} face_columns[] = {
#define ROW(name, count, unit, text) {#name, count, unit, text},
    TRB_FACE_COLUMNS(ROW)
#undef ROW
};
static const struct {
  const char *name, *unit, *text;
} channels[] = {
#define ROW(name, unit, text) {#name, unit, text},
    TRB_MOTION_CHANNELS(ROW)
#undef ROW
};
static const char *const quadratures[] = {
#define ROW(name) #name,
    TRB_QUADRATURES(ROW)
#undef ROW
};
static const struct {
  const char *name, *text;
} counters[] = {
#define ROW(name, text) {#name, text},
    TRB_COUNTERS(ROW)
#undef ROW
};
#define LENGTH(array) ((int)(sizeof(array) / sizeof((array)[0])))

TABLE(parameter_table, TRB_N_PARAMS, "(ssddss)", trb_param_table[i].name, trb_param_table[i].unit, trb_param_table[i].lower,
      trb_param_table[i].upper, trb_param_table[i].text, trb_param_table[i].part)
TABLE(face_table, LENGTH(face_columns), "(siss)", face_columns[i].name, face_columns[i].count, face_columns[i].unit, face_columns[i].text)
TABLE(motion_table, LENGTH(channels), "(sss)", channels[i].name, channels[i].unit, channels[i].text)
TABLE(field_table, TRB_N_FIELDS, "(sssss)", trb_field_table[i].name, trb_field_table[i].group, trb_field_kind_name(trb_field_table[i].kind),
      trb_field_table[i].unit, trb_field_table[i].text)
TABLE(peak_table, TRB_N_PEAK_FIELDS, "(ssssss)", trb_peak_field_table[i].name, "peaks",
      trb_field_kind_name(trb_peak_kind(&trb_peak_field_table[i])), trb_peak_field_table[i].unit, trb_peak_field_table[i].text,
      trb_peak_joined(&trb_peak_field_table[i]))
TABLE(geometry_table, TRB_N_GEOMETRY, "(sss)", trb_geometry_table[i].name, trb_geometry_table[i].unit, trb_geometry_table[i].text)
TABLE(quadrature_table, LENGTH(quadratures), "s", quadratures[i])
TABLE(counter_table, LENGTH(counters), "(ss)", counters[i].name, counters[i].text)
TABLE(law_table, trb_n_laws, "(sss)", trb_law_table[i].name, trb_law_table[i].arguments, trb_law_table[i].text)
TABLE(setting_table, TRB_N_SETTINGS, "(sddds)", trb_setting_table[i].name, trb_setting_table[i].standard, trb_setting_table[i].lower,
      trb_setting_table[i].upper, trb_setting_table[i].text)

static PyObject *law(PyObject *module, PyObject *arguments)
{
  const char *name;
  PyObject   *object;
  (void)module;
  if (!PyArg_ParseTuple(arguments, "sO", &name, &object)) return NULL;
  const trb_law *found = NULL;
  for (int i = 0; i < trb_n_laws && found == NULL; i++)
    if (strcmp(trb_law_table[i].name, name) == 0) found = &trb_law_table[i];
  if (found == NULL) return PyErr_Format(trb_input_error, "law '%s': not one of law_table()", name);
  PyArrayObject *x = trb_array(object, 2, "arguments");
  if (x == NULL) return NULL;
  if (PyArray_DIM(x, 0) != found->n) {
    PyErr_Format(trb_input_error, "law '%s': %d arguments (%s) needed, %d given", name, found->n, found->arguments, (int)PyArray_DIM(x, 0));
    Py_DECREF((PyObject *)x);
    return NULL;
  }
  const npy_intp n = PyArray_DIM(x, 1);
  PyObject      *out = trb_vector(NULL, n);
  if (out != NULL) {
    const double *from = PyArray_DATA(x);
    double       *to = PyArray_DATA((PyArrayObject *)out), row[TRB_LAW_MOST_ARGUMENTS];
    for (npy_intp i = 0; i < n; i++) {
      for (int k = 0; k < found->n; k++) row[k] = from[k * n + i];
      to[i] = found->function(row);
    }
  }
  Py_DECREF((PyObject *)x);
  return out;
}

static PyObject *geometry(PyObject *module, PyObject *object)
{
  (void)module;
  PyArrayObject *block = trb_array(object, 1, "params");
  trb_geometry   out;
  trb_message    message = {TRB_OK, ""};
  if (block == NULL) return NULL;
  if (PyArray_DIM(block, 0) != TRB_N_PARAMS) {
    Py_DECREF((PyObject *)block);
    return PyErr_Format(trb_input_error, "params: %d values needed", TRB_N_PARAMS);
  }
  const trb_status status = trb_geometry_derive(PyArray_DATA(block), &out, &message);
  Py_DECREF((PyObject *)block);
  if (status != TRB_OK) return trb_raise(status, &message);
  return trb_vector((const double *)&out, TRB_N_GEOMETRY);
}

static PyObject *instruction_sets(PyObject *module, PyObject *none)
{
  (void)module;
  (void)none;
  PyObject *list = PyList_New(0);
  for (int i = 0; list != NULL && i < trb_n_kernel_variants; i++)
    if (trb_kernel_runs(i) && append(list, PyUnicode_FromString(trb_kernel_variants[i].name)) != 0) Py_CLEAR(list);
  return list;
}

static PyObject *sundials_version(PyObject *module, PyObject *none)
{
  (void)module;
  (void)none;
  return PyUnicode_FromString(trb_sundials_version());
}

static PyObject *version(PyObject *module, PyObject *none)
{
  (void)module;
  (void)none;
  return PyUnicode_FromString(TRBDYN_VERSION);
}

static PyMethodDef functions[] = {
    {"parameter_table", parameter_table, METH_NOARGS, "(name, unit, lower, upper, text, part) of the parameter block."},
    {"face_table", face_table, METH_NOARGS, "(name, count, unit, text) of the columns of a pocket face."},
    {"motion_table", motion_table, METH_NOARGS, "(name, unit, text) of the channels of prescribed motion."},
    {"field_table", field_table, METH_NOARGS, "(name, group, kind, unit, text) of every recorded quantity."},
    {"peak_table", peak_table, METH_NOARGS, "(name, group, kind, unit, text, how two intervals are joined) of every peak."},
    {"geometry_table", geometry_table, METH_NOARGS, "(name, unit, text) of the derived geometry."},
    {"quadrature_table", quadrature_table, METH_NOARGS, "Names of the energy quadratures."},
    {"counter_table", counter_table, METH_NOARGS, "(name, text) of the evaluation counters."},
    {"law_table", law_table, METH_NOARGS, "(name, arguments, text) of the laws."},
    {"setting_table", setting_table, METH_NOARGS, "(name, default, lower, upper, text) of an integration's settings."},
    {"law", law, METH_VARARGS, "law(name, arguments): a law over the columns of a 2-D array."},
    {"geometry", geometry, METH_O, "Derived geometry of a parameter block."},
    {"state_layouts", trb_python_state_layouts, METH_O,
     "state_layouts(models): length of the state of bearings that are simulated together, and the layout of each one's part."},
    {"instruction_sets", instruction_sets, METH_NOARGS, "Kernel variants that this machine runs, slowest first."},
    {"sundials_version", sundials_version, METH_NOARGS, "Version of SUNDIALS that this was built with."},
    {"version", version, METH_NOARGS, "Version of this package."},
    {NULL, NULL, 0, NULL},
};

static int add_exception(PyObject *module, const char *name, const char *text, PyObject *bases, PyObject **to)
{
  char full[64];
  (void)PyOS_snprintf(full, sizeof full, "trbdyn._core.%s", name);
  if (*to == NULL) *to = PyErr_NewExceptionWithDoc(full, text, bases, NULL); /* one, however often the module is loaded */
  return *to == NULL ? -1 : PyModule_AddObjectRef(module, name, *to);
}

static int add_exceptions(PyObject *module)
{
  if (add_exception(module, "CoreError", "An error of the core.", NULL, &trb_error) != 0) return -1;
  PyObject *bases = PyTuple_Pack(2, trb_error, PyExc_ValueError);
  if (bases == NULL) return -1;
  const int failed = add_exception(module, "CoreInputError", "Input out of range.", bases, &trb_input_error);
  Py_DECREF(bases);
  if (failed != 0) return -1;
  if (add_exception(module, "CoreLoadError", "No equilibrium under a load.", trb_error, &trb_load_error) != 0) return -1;
  return add_exception(module, "CoreStepError", "The integrator could not go on.", trb_error, &trb_step_error);
}

static int add_type(PyObject *module, const char *name, PyType_Spec *spec, PyTypeObject **to)
{
  if (*to == NULL) *to = (PyTypeObject *)PyType_FromSpec(spec); /* one, however often the module is loaded */
  return *to == NULL ? -1 : PyModule_AddObjectRef(module, name, (PyObject *)*to);
}

static int add_number(PyObject *module, const char *name, double value)
{
  PyObject *number = PyFloat_FromDouble(value);
  const int failed = number == NULL ? -1 : PyModule_AddObjectRef(module, name, number);
  Py_XDECREF(number);
  return failed;
}

static int execute(PyObject *module)
{
  /* types and exceptions are static: another interpreter would share them, and NumPy's */
  if (PyInterpreterState_GetID(PyInterpreterState_Get()) != 0) { /* 0 is the main one */
    PyErr_SetString(PyExc_ImportError, "trbdyn works in the main interpreter alone, not in sub-interpreters; use threads or processes");
    return -1;
  }
  import_array1(-1);
  if (add_exceptions(module) != 0 || add_type(module, "Model", &trb_model_spec, &trb_model_type) != 0) return -1;
  if (add_type(module, "Simulation", &trb_simulation_spec, &trb_simulation_type) != 0) return -1;
  return add_number(module, "least_mode_frequency", trb_least_mode_frequency);
}

static PyModuleDef_Slot slots[] = {
    {Py_mod_exec, execute},
#if defined(Py_MOD_MULTIPLE_INTERPRETERS_NOT_SUPPORTED) && Py_LIMITED_API + 0 >= 0x030C0000
    {Py_mod_multiple_interpreters, Py_MOD_MULTIPLE_INTERPRETERS_NOT_SUPPORTED},
#endif
    {0, NULL},
};

static struct PyModuleDef definition = {PyModuleDef_HEAD_INIT, "_core", "The C core of trbdyn.", 0, functions, slots, NULL, NULL, NULL};

PyMODINIT_FUNC PyInit__core(void) { return PyModuleDef_Init(&definition); }
