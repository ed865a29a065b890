/* Error codes, from one list, and the message that goes with them. */
#ifndef TRB_BASE_STATUS_H
#define TRB_BASE_STATUS_H

#if defined(__GNUC__)
#define TRB_PRINTF(format_index, first) __attribute__((format(printf, format_index, first)))
#else
#define TRB_PRINTF(format_index, first)
#endif

#define TRB_STATUSES(X) \
  X(OK,            "no error") \
  X(ERR_MEMORY,    "out of memory") \
  X(ERR_INPUT,     "input out of range") \
  X(ERR_GEOMETRY,  "the geometry does not fit together") \
  X(ERR_LOAD,      "no equilibrium under this load") \
  X(ERR_STATE,     "a state that is not finite or not possible") \
  X(ERR_STEP,      "the integrator could not go on") \
  X(ERR_SOLVER,    "a call to the solver library failed") \
  X(STOPPED,       "stopped before the end, can go on")

typedef enum trb_status {
#define TRB_STATUS_ENUM(name, text) TRB_##name,
  TRB_STATUSES(TRB_STATUS_ENUM)
#undef TRB_STATUS_ENUM
      TRB_N_STATUSES
} trb_status;

enum { TRB_MESSAGE_LENGTH = 512 };

typedef struct trb_message {
  trb_status status;                   /* code of the last error */
  char       text[TRB_MESSAGE_LENGTH]; /* what happened, for a person */
} trb_message;

/* Name of a status code, for a person. */
const char *trb_status_text(trb_status status);

/* Fill the message (which may be NULL) and give the status back, so that callers can write: return trb_fail(...). */
trb_status trb_fail(trb_message *message, trb_status status, const char *format, ...) TRB_PRINTF(3, 4);

#endif
