// openrt.h: the former name of xvrml/mapper.h, for programs that were written for it.
#pragma once

#include "xvrml/mapper.h"
