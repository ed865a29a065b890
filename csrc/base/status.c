#include "base/status.h"

#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>

const char *trb_status_text(trb_status status)
{
  static const char *const texts[TRB_N_STATUSES] = {
#define TRB_STATUS_TEXT(name, text) text,
      TRB_STATUSES(TRB_STATUS_TEXT)
#undef TRB_STATUS_TEXT
  };
  return (status >= 0 && status < TRB_N_STATUSES) ? texts[status] : "unknown status";
}

trb_status trb_fail(trb_message *message, trb_status status, const char *format, ...)
{
  if (message != NULL) {
    va_list arguments;
    va_start(arguments, format);
    message->status = status;
    (void)vsnprintf(message->text, sizeof message->text, format, arguments);
    va_end(arguments);
  }
  return status;
}
