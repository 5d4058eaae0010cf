// expectation.h: what Python gives for the value of a field, for messages. [any thread]
#pragma once

#include <string>

#include "xvrml/types.h"

std::string expectation(xvrml::FieldType type); // "3 numbers", "numbers of shape (n, 3)"
