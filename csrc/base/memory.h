/* Memory for arrays. */
#ifndef TRB_BASE_MEMORY_H
#define TRB_BASE_MEMORY_H

#include <stddef.h>

/* Zeros that start with a cache line, so that vector loops load whole lines; freed by free. NULL: out of memory. */
void *trb_zeros(size_t count, size_t size);

/* Whether as many bytes can be had just now. For calls into libraries that do not look whether their own small allocations failed: asked
 * right before such a call, it turns a lack of memory into an error, unless another thread takes the last bytes in between. */
int trb_has_room(size_t bytes);

#endif
