// x3d_json.h: the reader of X3D in JSON (ISO/IEC 19776-5, as X3DJSONLD writes it): "@name" is an
// attribute, "-name" holds the child nodes of a field, "#sourceCode" the lines of a Script. [the
// thread that loads]
#pragma once

#include "base/budget.h"
#include "parse/x3d_elements.h"

namespace xvrml {

// Reads the locator's text. Members of an object may have any order. Text that is not well-formed
// ends the file: what stands before is kept. budget: for the index of the file.
void readX3dJson(Locator& locator, const BudgetPtr& budget, X3dElements& elements);

} // namespace xvrml
