#include "stepping/recorder.h"

#include <pthread.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>

/* Places of the queue, and how many of them are filled before a thread that waits for work is woken: to wake it costs as much as to compute
 * a state, and nobody needs its results before the recorder is closed. */
enum { PLACES = 64, ENOUGH = 8 };

/* A state in the queue. */
typedef struct place {
  double   *row; /* of a record; NULL: the end of a step */
  double    time;
  double   *y;
  unsigned *apart; /* of a record: see trb_dynamics_apart */
} place;

struct trb_recorder {
  trb_recorder_parts parts;
  size_t             n_state;
  place              queue[PLACES];
  unsigned long      put, taken; /* states put into the queue, and computed, since the beginning */
  int                closing;
  pthread_mutex_t    lock; /* of put, taken and closing */
  pthread_cond_t     has_work, has_room;
  pthread_t          thread;
};

static void compute(const trb_recorder *r, const place *at)
{
  const trb_recorder_parts *parts = &r->parts;
  if (at->row == NULL) {
    trb_peaks_step(parts->peaks, at->time, at->y);
    return;
  }
  trb_record_fill(parts->onlooker, at->apart, at->time, at->y, parts->detail, at->row);
  if (parts->peaks != NULL) trb_peaks_record(parts->peaks, at->time, at->row + trb_record_offset(parts->model, TRB_N_FIELDS));
}

static void *work(void *recorder)
{
  trb_recorder *r = recorder;
  pthread_mutex_lock(&r->lock);
  for (;;) {
    while (r->taken == r->put && !r->closing) pthread_cond_wait(&r->has_work, &r->lock);
    if (r->taken == r->put) break;
    const place *next = &r->queue[r->taken % PLACES];
    pthread_mutex_unlock(&r->lock);
    compute(r, next);
    pthread_mutex_lock(&r->lock);
    r->taken++; /* one at a time, so that the stepping need not wait for the whole queue */
    pthread_cond_signal(&r->has_room);
  }
  pthread_mutex_unlock(&r->lock);
  return NULL;
}

/* The next place, once it is free. */
static place *reserve(trb_recorder *r)
{
  pthread_mutex_lock(&r->lock);
  while (r->put - r->taken == PLACES) pthread_cond_wait(&r->has_room, &r->lock);
  place *next = &r->queue[r->put % PLACES];
  pthread_mutex_unlock(&r->lock);
  return next;
}

/* The thread waits only when the queue is empty: so it is woken when there is exactly enough. */
static void hand_over(trb_recorder *r)
{
  pthread_mutex_lock(&r->lock);
  r->put++;
  if (r->put - r->taken == ENOUGH) pthread_cond_signal(&r->has_work);
  pthread_mutex_unlock(&r->lock);
}

void trb_recorder_step(trb_recorder *r, double time, const double *y)
{
  place *next = reserve(r);
  next->row = NULL;
  next->time = time;
  memcpy(next->y, y, r->n_state * sizeof *y);
  hand_over(r);
}

void trb_recorder_record(trb_recorder *r, const trb_dynamics *stepping, double time, const double *y, double *row)
{
  place *next = reserve(r);
  next->row = row;
  next->time = time;
  memcpy(next->y, y, r->n_state * sizeof *y);
  trb_dynamics_apart(stepping, y, next->apart);
  hand_over(r);
}

static void release(trb_recorder *r)
{
  for (int i = 0; i < PLACES; i++) {
    free(r->queue[i].y);
    free(r->queue[i].apart);
  }
  free(r);
}

/* Signals are for the thread that called: Ctrl-C must reach Python's own. */
static int start_without_signals(trb_recorder *r)
{
  sigset_t all, before;
  sigfillset(&all);
  if (pthread_sigmask(SIG_SETMASK, &all, &before) != 0) return -1;
  const int failed = pthread_create(&r->thread, NULL, work, r);
  pthread_sigmask(SIG_SETMASK, &before, NULL);
  return failed;
}

trb_recorder *trb_recorder_open(const trb_recorder_parts *parts, int n_state)
{
  trb_recorder *r = calloc(1, sizeof *r);
  if (r == NULL) return NULL;
  r->parts = *parts;
  r->n_state = (size_t)n_state;
  int complete = 1;
  for (int i = 0; i < PLACES; i++) {
    r->queue[i].y = calloc(r->n_state, sizeof(double));
    r->queue[i].apart = calloc((size_t)parts->model->n_rollers, sizeof(unsigned));
    complete = complete && r->queue[i].y != NULL && r->queue[i].apart != NULL;
  }
  if (complete && pthread_mutex_init(&r->lock, NULL) == 0) {
    if (pthread_cond_init(&r->has_work, NULL) == 0) {
      if (pthread_cond_init(&r->has_room, NULL) == 0) {
        if (start_without_signals(r) == 0) return r;
        pthread_cond_destroy(&r->has_room);
      }
      pthread_cond_destroy(&r->has_work);
    }
    pthread_mutex_destroy(&r->lock);
  }
  release(r);
  return NULL;
}

void trb_recorder_close(trb_recorder *r)
{
  if (r == NULL) return;
  pthread_mutex_lock(&r->lock);
  r->closing = 1;
  pthread_cond_signal(&r->has_work);
  pthread_mutex_unlock(&r->lock);
  pthread_join(r->thread, NULL);
  pthread_cond_destroy(&r->has_room);
  pthread_cond_destroy(&r->has_work);
  pthread_mutex_destroy(&r->lock);
  release(r);
}
