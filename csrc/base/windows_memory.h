/* Memory under Windows, included before every source there (see TrbFlags.cmake). C11's aligned_alloc does not exist in Windows, as its
 * free cannot release aligned memory; only _aligned_free can. So all memory of the core is taken and released by the aligned functions,
 * and a source need not be written twice. */
#ifndef TRB_BASE_WINDOWS_MEMORY_H
#define TRB_BASE_WINDOWS_MEMORY_H

#include <malloc.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* What malloc promises for every type. */
enum { TRB_MALLOC_ALIGNMENT = 16 };

static inline void *trb_windows_calloc(size_t count, size_t size)
{
  if (size > 0 && count > SIZE_MAX / size) return NULL;
  void *made = _aligned_malloc(count * size > 0 ? count * size : 1, TRB_MALLOC_ALIGNMENT);
  if (made != NULL) memset(made, 0, count * size);
  return made;
}

#define aligned_alloc(alignment, bytes) _aligned_malloc(bytes, alignment)
#define malloc(bytes)                   _aligned_malloc(bytes, TRB_MALLOC_ALIGNMENT)
#define calloc(count, size)             trb_windows_calloc(count, size)
#define realloc(old, bytes)             _aligned_realloc(old, bytes, TRB_MALLOC_ALIGNMENT)
#define free _aligned_free /* also the members of structs with this name */

#endif
