/* Memory for arrays. */
#ifndef TRB_BASE_MEMORY_H
#define TRB_BASE_MEMORY_H

#include <stddef.h>

/* Zeros that start with a cache line, so that vector loops load whole lines; freed by free. NULL: out of memory. */
void *trb_zeros(size_t count, size_t size);

#endif
