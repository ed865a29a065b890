/* A second thread, a lock and a condition: POSIX threads, or those of Windows. C11's own threads are missing in macOS and in most
 * compilers for Windows. Functions give 0 when all went well. */
#ifndef TRB_BASE_THREAD_H
#define TRB_BASE_THREAD_H

#ifdef _WIN32

#define WIN32_LEAN_AND_MEAN
#include <windows.h>

typedef HANDLE             trb_thread;
typedef SRWLOCK            trb_lock;
typedef CONDITION_VARIABLE trb_condition;

/* What a thread does: written as TRB_THREAD_WORK(name, argument) { ...; return 0; } */
#define TRB_THREAD_WORK(name, argument) static DWORD WINAPI name(LPVOID argument)
typedef LPTHREAD_START_ROUTINE trb_thread_work;

static inline int trb_lock_open(trb_lock *lock)
{
  InitializeSRWLock(lock);
  return 0;
}
static inline void trb_lock_close(trb_lock *lock) { (void)lock; }
static inline void trb_lock_take(trb_lock *lock) { AcquireSRWLockExclusive(lock); }
static inline void trb_lock_give(trb_lock *lock) { ReleaseSRWLockExclusive(lock); }

static inline int trb_condition_open(trb_condition *condition)
{
  InitializeConditionVariable(condition);
  return 0;
}
static inline void trb_condition_close(trb_condition *condition) { (void)condition; }
static inline void trb_condition_wait(trb_condition *condition, trb_lock *lock) { SleepConditionVariableSRW(condition, lock, INFINITE, 0); }
static inline void trb_condition_wake(trb_condition *condition) { WakeConditionVariable(condition); }

static inline int trb_thread_start(trb_thread *thread, trb_thread_work work, void *argument)
{
  *thread = CreateThread(NULL, 0, work, argument, 0, NULL);
  return *thread == NULL;
}
static inline void trb_thread_join(trb_thread thread)
{
  WaitForSingleObject(thread, INFINITE);
  CloseHandle(thread);
}

#else

#include <pthread.h>
#include <signal.h>

typedef pthread_t       trb_thread;
typedef pthread_mutex_t trb_lock;
typedef pthread_cond_t  trb_condition;

/* What a thread does: written as TRB_THREAD_WORK(name, argument) { ...; return 0; } */
#define TRB_THREAD_WORK(name, argument) static void *name(void *argument)
typedef void *(*trb_thread_work)(void *);

static inline int  trb_lock_open(trb_lock *lock) { return pthread_mutex_init(lock, NULL); }
static inline void trb_lock_close(trb_lock *lock) { pthread_mutex_destroy(lock); }
static inline void trb_lock_take(trb_lock *lock) { pthread_mutex_lock(lock); }
static inline void trb_lock_give(trb_lock *lock) { pthread_mutex_unlock(lock); }

static inline int  trb_condition_open(trb_condition *condition) { return pthread_cond_init(condition, NULL); }
static inline void trb_condition_close(trb_condition *condition) { pthread_cond_destroy(condition); }
static inline void trb_condition_wait(trb_condition *condition, trb_lock *lock) { pthread_cond_wait(condition, lock); }
static inline void trb_condition_wake(trb_condition *condition) { pthread_cond_signal(condition); }

/* Signals are for the thread that starts this one: Ctrl-C must reach Python's own. */
static inline int trb_thread_start(trb_thread *thread, trb_thread_work work, void *argument)
{
  sigset_t all, before;
  sigfillset(&all);
  if (pthread_sigmask(SIG_SETMASK, &all, &before) != 0) return -1;
  const int failed = pthread_create(thread, NULL, work, argument);
  pthread_sigmask(SIG_SETMASK, &before, NULL);
  return failed;
}
static inline void trb_thread_join(trb_thread thread) { pthread_join(thread, NULL); }

#endif
#endif
