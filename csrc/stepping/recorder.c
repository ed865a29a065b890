/* A queue between two threads without a lock. Each thread counts what it has put or taken, reads the other's count, and so knows which
 * places are its own. The lock is only for a thread that waits: it says so before it looks at the counts for the last time, and the other
 * one looks whether anybody waits after it has counted; so one of the two sees the other (all of these are sequentially consistent).
 *
 * To wake a thread costs as much as to compute a state, and nobody needs the results before the recorder is closed. So the second thread is
 * woken when there is enough to do, and the stepping, when the queue was full, when half of it is free. */
#include "stepping/recorder.h"

#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "base/thread.h"
#include "motion/fast_pairs.h"
#include "stepping/constants.h"

/* A state in the queue. */
typedef struct place {
  double   *row; /* of a record; NULL: the end of a step */
  double    time;
  double   *y;
  unsigned *apart; /* of a record: see trb_fast_apart; of all rollers */
} place;

struct trb_recorder {
  const trb_record_parts *parts; /* of n bearings */
  int                     n;
  size_t                  n_state;
  place                   queue[TRB_QUEUE_PLACES];
  atomic_ulong            put, taken;    /* states put into the queue, and computed, since the beginning */
  atomic_int              idle, held_up; /* whether the second thread waits for work, and the stepping for room */
  int                     closing;
  trb_lock                lock; /* of waiting, and of closing */
  trb_condition           has_work, has_room;
  trb_thread              thread;
  trb_memory              memory; /* of the queue */
};

int trb_record_parts_length(const trb_record_parts *parts)
{
  const trb_system *s = parts->onlooker->system;
  return trb_record_offset(s, TRB_N_FIELDS) + (parts->peaks != NULL ? trb_peak_offset(s, TRB_N_PEAK_FIELDS) : 0);
}

void trb_record_parts_fill(const trb_record_parts *parts, const unsigned *apart, double time, const double *y, double *row)
{
  trb_record_fill(parts->onlooker, apart, time, y, parts->detail, row);
  if (parts->peaks != NULL) trb_peaks_record(parts->peaks, time, row + trb_record_offset(parts->onlooker->system, TRB_N_FIELDS));
}

static void compute(const trb_recorder *r, const place *at)
{
  double *row = at->row;
  for (int k = 0; k < r->n; k++) {
    const trb_record_parts *parts = &r->parts[k];
    if (at->row == NULL) {
      trb_peaks_step(parts->peaks, at->time, at->y);
      continue;
    }
    trb_record_parts_fill(parts, at->apart + parts->onlooker->system->layout.leaf, at->time, at->y, row);
    row += trb_record_parts_length(parts);
  }
}

/* How many places are filled. */
static unsigned long filled(trb_recorder *r) { return r->put - r->taken; }

/* Wake a thread that waits. */
static void wake(trb_recorder *r, atomic_int *waits, trb_condition *condition)
{
  trb_lock_take(&r->lock);
  *waits = 0;
  trb_condition_wake(condition);
  trb_lock_give(&r->lock);
}

/* Wait until there is enough to do, or the end; gives 0 where nothing is left and nothing will come. */
static int wait_for_work(trb_recorder *r)
{
  trb_lock_take(&r->lock);
  for (r->idle = 1; filled(r) < TRB_QUEUE_ENOUGH && !r->closing; r->idle = 1) trb_condition_wait(&r->has_work, &r->lock);
  r->idle = 0;
  const int more = filled(r) > 0 || !r->closing;
  trb_lock_give(&r->lock);
  return more;
}

static void wait_for_room(trb_recorder *r)
{
  trb_lock_take(&r->lock);
  for (r->held_up = 1; filled(r) > TRB_QUEUE_PLACES - TRB_QUEUE_FREE; r->held_up = 1) trb_condition_wait(&r->has_room, &r->lock);
  r->held_up = 0;
  trb_lock_give(&r->lock);
}

TRB_THREAD_WORK(work, recorder)
{
  trb_recorder *r = recorder;
  while (wait_for_work(r)) {
    while (filled(r) > 0) {
      compute(r, &r->queue[r->taken % TRB_QUEUE_PLACES]);
      r->taken++;
      if (r->held_up && filled(r) <= TRB_QUEUE_PLACES - TRB_QUEUE_FREE) wake(r, &r->held_up, &r->has_room);
    }
  }
  return 0;
}

/* The next place, once it is free. */
static place *reserve(trb_recorder *r)
{
  if (filled(r) == TRB_QUEUE_PLACES) wait_for_room(r);
  return &r->queue[r->put % TRB_QUEUE_PLACES];
}

static void hand_over(trb_recorder *r)
{
  r->put++;
  if (r->idle && filled(r) >= TRB_QUEUE_ENOUGH) wake(r, &r->idle, &r->has_work);
}

void trb_recorder_put(trb_recorder *r, double time, const double *y, double *row)
{
  place *next = reserve(r);
  next->row = row;
  next->time = time;
  memcpy(next->y, y, r->n_state * sizeof *y);
  for (int k = 0; row != NULL && k < r->n; k++) {
    const trb_dynamics *stepping = r->parts[k].stepping;
    trb_fast_apart(stepping, y, next->apart + stepping->system->layout.leaf);
  }
  hand_over(r);
}

static void release(trb_recorder *r)
{
  trb_memory_free(&r->memory);
  free(r);
}

trb_recorder *trb_recorder_open(const trb_record_parts *parts, int n, int n_state)
{
  trb_recorder *r = calloc(1, sizeof *r);
  if (r == NULL) return NULL;
  r->parts = parts;
  r->n = n;
  r->n_state = (size_t)n_state;
  for (int i = 0; i < TRB_QUEUE_PLACES; i++) {
    r->queue[i].y = trb_memory_zeros(&r->memory, r->n_state, sizeof(double));
    r->queue[i].apart = trb_memory_zeros(&r->memory, (size_t)parts[0].onlooker->system->layout.n_rollers, sizeof(unsigned));
  }
  if (!r->memory.lacks && trb_lock_open(&r->lock) == 0) {
    if (trb_condition_open(&r->has_work) == 0) {
      if (trb_condition_open(&r->has_room) == 0) {
        if (trb_thread_start(&r->thread, work, r) == 0) return r;
        trb_condition_close(&r->has_room);
      }
      trb_condition_close(&r->has_work);
    }
    trb_lock_close(&r->lock);
  }
  release(r);
  return NULL;
}

void trb_recorder_close(trb_recorder *r)
{
  if (r == NULL) return;
  trb_lock_take(&r->lock);
  r->closing = 1;
  trb_condition_wake(&r->has_work);
  trb_lock_give(&r->lock);
  trb_thread_join(r->thread);
  trb_condition_close(&r->has_room);
  trb_condition_close(&r->has_work);
  trb_lock_close(&r->lock);
  release(r);
}
