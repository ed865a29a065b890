#include "bearing/params.h"

const trb_param_info trb_param_table[TRB_N_PARAMS] = {
#define TRB_PARAM_INFO(part, name, unit, lower, upper, text) {#name, unit, lower, upper, text, #part},
    TRB_PARAMS(TRB_PARAM_INFO)
#undef TRB_PARAM_INFO
};
