// appearance_object.h: what Python sees of an appearance. [GIL held]
#pragma once

#include "objects.h"
#include "xvrml/appearance.h"

// Returns a class of xvrml/_renderer.py.
py::object classInPython(const char* name);
// Returns an AppearanceParts.
py::object appearanceObject(const WorldPtr& world, const xvrml::AppearanceParts& parts);
