// openrt.h: the former name of xvrml/mapper.h, kept for programs that include it.
#pragma once

#include "xvrml/mapper.h"
