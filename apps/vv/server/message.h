// message.h: Reads the messages of a page. Everything in them is hostile: a message has exactly the
// members of its type, each of its kind and within its range, or it is refused with a text that
// says why. docs/serve.md lists the messages. [any thread]
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "server/edit_command.h"
#include "session/input/input.h"

namespace vv::server {

struct Message {
  enum class Type : uint8_t {
    size,      // width, height: pixels of the device that the page has for the picture
    shown,     // picture: the number of the picture that the page has shown
    input,     // the user's mouse, finger or key
    viewpoint, // number: the viewpoint of the list, from 0
    own,       // the page wants a view of its own
    follow,    // the page wants the view of the one who leads
    save,      // format: the picture is wanted as a file
    command,   // the command of the view is wanted
    edit       // editCommand: the world is edited
  };
  enum class Format : uint8_t { png, exr };

  Type type = Type::input;
  int width = 0, height = 0;
  uint32_t picture = 0;
  InputEvent input;
  int number = 0;
  Format format = Format::png;
  std::optional<edit::Command> editCommand;
};

struct ReadMessage {
  std::optional<Message> message; // none: it was refused
  std::string fault;              // why
};

// Says what a page may do beside looking: from others than editors no edits are read.
enum class Rights : uint8_t { view, edit };

ReadMessage readMessage(std::string_view text, Rights rights = Rights::view);

} // namespace vv::server
