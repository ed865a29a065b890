#include "base/memory.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { LINE = 64 };

void *trb_zeros(size_t count, size_t size)
{
  if (size > 0 && count > (SIZE_MAX - LINE) / size) return NULL;
  const size_t lines = (count * size + LINE - 1) / LINE, bytes = (lines > 0 ? lines : 1) * LINE;
  void        *made = aligned_alloc(LINE, bytes);
  if (made != NULL) memset(made, 0, bytes);
  return made;
}

/* What is in a line before each array. */
typedef struct trb_array {
  struct trb_array *before; /* the one that was made before */
} trb_array;

void *trb_memory_zeros(trb_memory *memory, size_t count, size_t size)
{
  const int  fits = size == 0 || count <= (SIZE_MAX - 2 * LINE) / size;
  trb_array *made = fits ? trb_zeros(LINE + count * size, 1) : NULL;
  if (made == NULL) {
    memory->lacks = 1;
    return NULL;
  }
  made->before = memory->last;
  memory->last = made;
  return (char *)made + LINE;
}

void trb_memory_free(trb_memory *memory)
{
  while (memory->last != NULL) {
    trb_array *made = memory->last;
    memory->last = made->before;
    free(made);
  }
}

int trb_has_room(size_t bytes)
{
  void *volatile room = malloc(bytes); /* volatile: a compiler may leave out memory that nobody uses */
  const int found = room != NULL;
  free(room);
  return found;
}
