#include "bearing/params.h"

const trb_param_info trb_param_table[TRB_N_PARAMS] = {
#define TRB_PARAM_INFO(part, field, name, unit, lower, upper, text) {#name, unit, lower, upper, text, #part},
#define TRB_PART_INFO(part, INPUTS) INPUTS(TRB_PARAM_INFO)
    TRB_PARTS(TRB_PART_INFO)
#undef TRB_PARAM_INFO
#undef TRB_PART_INFO
};
