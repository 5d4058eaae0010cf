// merged_list.h: Brings the elements of a list that a user changes together with those that change
// by themselves meanwhile. Pure functions. [any thread]
#pragma once

#include <string>
#include <vector>

#include "xvrml/types.h"

namespace vv {

// Notes which elements of a list differ from those that the user was shown. Does nothing with other
// values, and with lists of another length.
void noteTouched(const xvrml::Value& shown, const xvrml::Value& wanted, std::vector<bool>& touched);

// A list that a user changes.
struct ChangedList {
  xvrml::Value shown, wanted; // what the user saw, and wants
  std::vector<bool> touched;  // elements
};
// Returns what the user wants, with the elements of now where the user has touched none. Throws
// xvrml::EditError if the lengths differ, because then it is not known which element is which;
// isOwn: they do not count, because it is the user who has made the list what it is now. what:
// names the field. Values that are no lists stay as they are wanted.
xvrml::Value mergedList(const ChangedList& change, const xvrml::Value& now, bool isOwn,
                        const std::string& what);

} // namespace vv
