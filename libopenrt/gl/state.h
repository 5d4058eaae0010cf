// state.h: the state of OpenGL that a program sees, and the recorder of its calls. There is one for
// each thread; it belongs to the context that is current there.
#pragma once

#include <exception>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <unordered_map>

#include "gl/failure.h"
#include "gl/frame.h"
#include "gl/scene.h"
#include "gl/selection.h"
#include "gl/textures.h"

namespace rtgl {

class State;
using Command = std::function<void(State&)>;
struct List {
  std::vector<Command> commands;
};

// A vertex array of the client.
struct ClientArray {
  bool on = false;
  GLint size = 4;
  GLenum type = GL_FLOAT;
  GLsizei stride = 0;
  const void* pointer = nullptr;
};
struct ClientArrays {
  ClientArray vertex, normal = {false, 3, GL_FLOAT, 0, nullptr}, color, texCoord;
};
struct PixelStore {
  GLint alignment = 4, rowLength = 0, skipRows = 0, skipPixels = 0;
};

// Wide because OpenGL is one state, which nearly every call changes.
class State {
 public:
  explicit State(RTcontext context) : context_(context) {}
  RTcontext context() const { return context_; }

  Attributes now;
  ClientArrays arrays;
  PixelStore unpack, pack;
  Textures textures;
  Selection selection;
  std::map<GLuint, std::shared_ptr<const List>> lists;
  Scene scene;
  bool singleBuffer = false;

  // Errors. refuse() records the name once, with what to use instead.
  void record(GLenum code, const std::string& text);
  void refuse(const std::string& name, const std::string& instead);
  GLenum takeError();
  void setErrorCallback(RTerrorCallback callback, void* user);

  // Vertices.
  void begin(GLenum mode);
  void end();
  bool open() const { return chunk_ != nullptr; }
  void vertex(float x, float y, float z);
  void setColor(const Color& color);
  // Lets the material follow the current colour, if glColorMaterial asks for it.
  void trackColor();
  void setNormal(float x, float y, float z);
  void setTexCoord(float s, float t);
  // Lets the list that is being compiled have the open primitive as single commands, because what
  // is called next may be a part of it.
  void unroll();
  // Draws a chunk under what is current.
  void draw(const ChunkPtr& chunk);

  // Display lists.
  void newList(GLuint name, GLenum mode);
  void endList();
  bool compiles() const { return list_ != nullptr; }
  bool executes() const { return !list_ || listMode_ == GL_COMPILE_AND_EXECUTE; }
  void add(Command command) { list_->commands.push_back(std::move(command)); }
  // The commands of lists that lists call are bounded, because their number may grow with a power
  // of the depth.
  void callList(GLuint name);
  GLuint listName() const { return listName_; }

  // Matrices.
  std::vector<Matrix>& stack();
  Matrix& top() { return stack().back(); }
  const Matrix& modelview() const { return modelview_.back(); }
  const Matrix& projection() const { return projection_.back(); }
  const Matrix& textureMatrix() const { return texture_.back(); }
  size_t depthOf(GLenum mode) const;
  size_t attributeDepth() const { return attributes_.size(); }

  void pushAttributes(GLbitfield mask);
  void popAttributes();
  struct SavedClient { // by glPushClientAttrib
    GLbitfield mask;
    ClientArrays arrays;
    PixelStore unpack, pack;
  };
  std::vector<SavedClient> clientStack;

  // Frames.
  void clear(GLbitfield mask);
  bool drewSomething() const { return !frame_.draws.empty() || cleared_; }
  // Renders the frame as it is by now, without ending it.
  bool showFrame();
  bool endFrame();

 private:
  // Tells whether calls are compiled; commands of a list that is executed are not.
  bool records() const { return compiles() && listDepth_ == 0; }
  // Tells whether a vertex, or what is current for it, is a command of its own.
  bool recordsAlone() const { return records() && (!open() || isUnrolled_); }
  Part partOf(const ChunkPtr& chunk);
  Material material(bool colored, const Color& color) const;
  void beginFrame();
  void useLights();
  Matrix placed() const;
  void drawOver(const Part& part, const Material& material);

  RTcontext context_;
  GLenum error_ = GL_NO_ERROR;
  std::string errorText_;
  std::set<std::string> refused_;
  RTerrorCallback callback_ = nullptr;
  void* user_ = nullptr;

  std::shared_ptr<Chunk> chunk_;
  Current recording_;       // what is current for the next vertex
  bool inherits_ = false;   // its first vertices inherit what is current when it is drawn
  bool isUnrolled_ = false; // the list has its vertices as single commands
  std::shared_ptr<List> list_;
  GLuint listName_ = 0;
  GLenum listMode_ = GL_COMPILE;
  int listDepth_ = 0;
  size_t nestedCommands_ = 0; // commands of lists that the outermost one has called

  std::vector<Matrix> modelview_{identity}, projection_{identity}, texture_{identity};
  struct Saved { // by glPushAttrib
    GLbitfield mask;
    Attributes attributes;
    TextureProperties texture; // those of the bound texture
  };
  std::vector<Saved> attributes_;
  Frame frame_;
  bool cleared_ = false;
  bool isShown_ = false; // the picture is that of the frame as it is
};

// Fails because a primitive has more than maxVertices vertices.
[[noreturn]] void failForVertices();
// Returns the text of the error that takeError() returned last on this thread.
const char* lastErrorText();
// Returns the state of this thread's context; makes a context if there is none.
State& state();
void resetState();

// Runs a call. Exceptions become errors of OpenGL.
template <class Body> void guarded(const char* name, Body&& body) noexcept {
  try {
    State& s = state();
    try {
      body(s);
    } catch (const Failure& failure) {
      s.record(failure.code, std::string(name) + ": " + failure.text);
    } catch (const std::exception&) { // no memory, or a size that none can have
      s.record(GL_OUT_OF_MEMORY, std::string(name) + ": out of memory");
    }
  } catch (...) {} // no context can be made: rtGetError tells why
}

// Runs a call that display lists may hold.
template <class Body> void listed(const char* name, Body&& body) noexcept {
  guarded(name, [&](State& s) {
    if (s.compiles()) s.add(body);
    if (s.executes()) body(s);
  });
}

} // namespace rtgl
