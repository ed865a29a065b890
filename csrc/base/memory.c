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

int trb_has_room(size_t bytes)
{
  void *volatile room = malloc(bytes); /* volatile: a compiler may leave out memory that nobody uses */
  const int found = room != NULL;
  free(room);
  return found;
}
