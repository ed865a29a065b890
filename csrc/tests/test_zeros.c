/* Arrays start with a cache line and hold zeros; one that cannot exist is refused. */
#include <stdint.h>
#include <stdlib.h>

#include "base/memory.h"
#include "check.h"

static void check_array(size_t count, size_t size)
{
  unsigned char *array = trb_zeros(count, size);
  unsigned       any = 0;
  if (!CHECK(array != NULL)) return;
  CHECK((uintptr_t)array % 64 == 0);
  for (size_t i = 0; i < count * size; i++) any |= array[i];
  CHECK(any == 0);
  free(array);
}

int main(void)
{
  check_array(0, 8);
  check_array(1, 1);
  check_array(9, 8);
  check_array(1000, 24);
  CHECK(trb_zeros(SIZE_MAX / 8 + 1, 8) == NULL);
  CHECK(trb_zeros(SIZE_MAX, 1) == NULL);
  return check_report();
}
