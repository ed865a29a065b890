#include "body/state.h"

trb_tolerance trb_state_tolerance(const trb_model *m, int index)
{
#define TRB_STATE_KIND(name, kind, text) TRB_TOL_##kind,
  static const trb_tolerance roller[TRB_ROLLER_SIZE] = {TRB_ROLLER_STATE(TRB_STATE_KIND)};
#undef TRB_STATE_KIND
  if (index < trb_state_hub(m)) return roller[index % TRB_ROLLER_SIZE];
  if (index < trb_state_main_size(m)) {
    int                       coordinate;
    const trb_hub_kind *const kind = trb_hub_kind_at(m, index - trb_state_hub(m), &coordinate);
    return kind->coordinates[coordinate].tolerance;
  }
  return TRB_TOL_QUADRATURE;
}
