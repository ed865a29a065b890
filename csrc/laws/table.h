/* The laws by name, for tests and for users: the same functions that the kernels inline. */
#ifndef TRB_LAWS_TABLE_H
#define TRB_LAWS_TABLE_H

enum { TRB_LAW_MOST_ARGUMENTS = 7 };

typedef struct trb_law {
  const char *name;
  int         n;         /* number of arguments */
  const char *arguments; /* their names, separated by spaces */
  const char *text;      /* what it gives, with its source */
  double (*function)(const double *x);
} trb_law;

extern const trb_law trb_law_table[];
extern const int     trb_n_laws;

#endif
