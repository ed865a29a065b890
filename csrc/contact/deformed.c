#include "contact/deformed.h"

/* Motions of a face at the centre of mass of its roller, as a rigid one, for a unit of each mode: displacement, then turn. */
static void motions_at(const trb_modes *modes, const double *shape, trb_vec3 arm, double (*motions)[TRB_MOST_MODES])
{
  for (int i = 0; i < modes->n; i++, shape += TRB_SHAPE_ROOM) {
    const trb_vec3 turn = trb_v(shape[3], shape[4], shape[5]), carried = trb_cross(turn, arm);
    motions[0][i] = shape[0] + carried.x, motions[1][i] = shape[1] + carried.y, motions[2][i] = shape[2] + carried.z;
    motions[3][i] = turn.x, motions[4][i] = turn.y, motions[5][i] = turn.z;
  }
}

/* d(wrench on the roller)/d(its motion), as rows. */
static void rows_of(const trb_wrench columns[6], double rows[6][6])
{
  for (int c = 0; c < 6; c++) {
    const double column[6] = {columns[c].force.x,  columns[c].force.y,  columns[c].force.z,
                              columns[c].moment.x, columns[c].moment.y, columns[c].moment.z};
    for (int k = 0; k < 6; k++) rows[k][c] = column[k];
  }
}

/* The roller moves by minus the motion of the face, and the face is pushed by minus the wrench on the roller. */
static void add(int n, double (*motions)[TRB_MOST_MODES], const trb_wrench columns[6], trb_wrench *on_roller, double (*pull)[6],
                double *own)
{
  double rows[6][6];
  rows_of(columns, rows);
  for (int i = 0; i < n; i++) {
    double along[6] = {0};
    for (int k = 0; k < 6; k++)
      for (int c = 0; c < 6; c++) along[k] -= rows[k][c] * motions[c][i], pull[i][c] -= motions[k][i] * rows[k][c];
    on_roller[i].force = trb_add(on_roller[i].force, trb_v(along[0], along[1], along[2]));
    on_roller[i].moment = trb_add(on_roller[i].moment, trb_v(along[3], along[4], along[5]));
    for (int k = 0; k < 6; k++)
      for (int q = 0; q < n; q++) own[i * n + q] -= along[k] * motions[k][q];
  }
}

void trb_slopes_of_modes(const trb_deformed *deformed, const trb_face_shift *s, const trb_slopes *slopes, trb_vec3 place,
                         trb_modal_slopes *to)
{
  const trb_vec3 arm = trb_sub(trb_sub(place, s->middle), s->shift);
  double         motions[6][TRB_MOST_MODES];
  motions_at(deformed->modes, s->shapes, arm, motions);
  add(deformed->modes->n, motions, slopes->place, to->place, to->pull_place, to->own_place);
  add(deformed->modes->n, motions, slopes->velocity, to->rate, to->pull_rate, to->own_rate);
}
