/* Memory for arrays. */
#ifndef TRB_BASE_MEMORY_H
#define TRB_BASE_MEMORY_H

#include <stddef.h>

/* Zeros that start with a cache line, so that vector loops load whole lines; freed by free. NULL: out of memory. */
void *trb_zeros(size_t count, size_t size);

/* Arrays that are freed together. All zero: there is none yet. */
typedef struct trb_memory {
  struct trb_array *last;  /* the one that was made last */
  int               lacks; /* 1: one could not be had */
} trb_memory;

/* Zeros as above that belong to a memory. NULL, which the memory notes: out of memory. */
void *trb_memory_zeros(trb_memory *memory, size_t count, size_t size);
void  trb_memory_free(trb_memory *memory);

/* Whether as many bytes can be had just now. For calls into libraries that do not look whether their own small allocations failed: asked
 * right before such a call, it turns a lack of memory into an error, unless another thread takes the last bytes in between. */
int trb_has_room(size_t bytes);

#endif
