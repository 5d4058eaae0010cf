// trusted.cpp: Creates the interpreter of a trusted world: all of Tcl, and Tk if the program asks
// for it. Commands that would block the host are replaced: `vwait` and `tkwait` wait inside a
// coroutine while the world continues. [the browser's thread]
#include <filesystem>

#include <dlfcn.h>

#include "interpreter.h"

namespace tclscript {
namespace {

// Returns the folder of a bundled Tcl library, as a wheel contains it, beside the folder of script
// engines; empty if there is none. It matches the bundled libtcl; an installed library might not.
std::filesystem::path bundledLibrary() {
  static const char here = 0;
  std::error_code error;
  Dl_info info{};
  if (dladdr(&here, &info) == 0 || !info.dli_fname) return {};
  const std::filesystem::path folder =
      std::filesystem::path(info.dli_fname).parent_path() / "../tcl" TCL_VERSION;
  return std::filesystem::exists(folder / "init.tcl", error)
             ? std::filesystem::canonical(folder, error)
             : std::filesystem::path();
}

// Initializes Tcl's own procedures, from the bundled library if there is one.
int initialize(Tcl_Interp* tcl) {
  static const std::filesystem::path library = bundledLibrary();
  if (library.empty()) return Tcl_Init(tcl);
  Tcl_SetVar2Ex(tcl, "tcl_library", nullptr, tclText(library.c_str()).get(), TCL_GLOBAL_ONLY);
  const Object encodings(Tcl_NewListObj(0, nullptr));
  Tcl_ListObjAppendElement(nullptr, encodings.get(), tclText((library / "encoding").c_str()).get());
  Tcl_SetEncodingSearchPath(encodings.get());
  // Debian's Tcl has an absolute path for the folder of its modules (msgcat, which `clock` needs).
  return Tcl_Init(tcl) == TCL_OK
             ? Tcl_Eval(tcl, "::tcl::tm::path add [file join $tcl_library tcl8]")
             : TCL_ERROR;
}

// The prelude. The trace of vwait resumes the coroutine from the event loop instead of from within
// the assignment.
constexpr const char prelude[] = R"tcl(
namespace eval ::xvrml {
  variable tk 0
  rename ::puts ::xvrml::puts
  rename ::package ::xvrml::package
  rename ::vwait ::xvrml::vwait
}

proc ::xvrml::needCoroutine what {
  if {[info coroutine] eq {}} {
    return -level 2 -code error "$what would stop the world; it can wait within a coroutine: coroutine NAME COMMAND"
  }
}
proc ::xvrml::resume {coroutine args} {after 0 [list ::xvrml::goOn $coroutine]}
proc ::xvrml::goOn coroutine {if {[llength [info commands $coroutine]]} {$coroutine}}

proc ::vwait name {
  ::xvrml::needCoroutine vwait
  set resume [list ::xvrml::resume [info coroutine]]
  uplevel #0 [list trace add variable $name {write unset} $resume]
  yield
  uplevel #0 [list trace remove variable $name {write unset} $resume]
  return
}

proc ::package args {
  set code [catch {uplevel 1 [list ::xvrml::package {*}$args]} result options]
  if {$code && [lindex $args 0] eq "require" && "Tk" in $args} {
    return -code error "Tk cannot be used here: $result"
  }
  if {!$::xvrml::tk && [::xvrml::package provide Tk] ne {}} {
    set ::xvrml::tk 1
    ::xvrml::tkIsThere
  }
  dict incr options -level
  return -options $options $result
}

proc ::xvrml::tkIsThere {} {
  rename ::send {} ;# no other program of this display commands this one
  rename ::tkwait ::xvrml::tkwait
  proc ::tkwait {kind name} {
    ::xvrml::needCoroutine tkwait
    switch -- $kind {
      variable {uplevel 1 [list vwait $name]}
      window {
        bind $name <Destroy> +[list ::xvrml::resumeFor $name %W [info coroutine]]
        yield
      }
      visibility {
        if {[winfo exists $name] && ![winfo viewable $name]} {
          bind $name <Map> +[list ::xvrml::resumeFor $name %W [info coroutine]]
          yield
        }
      }
      default {return -code error "bad option \"$kind\": must be variable, visibility, or window"}
    }
    return
  }
  foreach dialog {tk_messageBox tk_getOpenFile tk_getSaveFile tk_chooseColor tk_chooseDirectory tk_dialog} {
    catch {::auto_load $dialog}
    if {[llength [info commands ::$dialog]] == 0} continue
    rename ::$dialog ::xvrml::$dialog
    proc ::$dialog args [string map [list DIALOG $dialog] {
      ::xvrml::needCoroutine DIALOG
      tailcall ::xvrml::DIALOG {*}$args
    }]
  }
}
proc ::xvrml::resumeFor {wanted window coroutine} {
  if {$wanted eq $window} {resume $coroutine}
}
)tcl";

// Reports errors of background events.
int backgroundError(ClientData data, Tcl_Interp* tcl, int count, Tcl_Obj* const words[]) {
  Interpreter& interpreter = *static_cast<Interpreter*>(data);
  if (count == 3 && !interpreter.isOver()) {
    Tcl_SetReturnOptions(tcl, words[2]);
    Tcl_SetObjResult(tcl, words[1]);
    interpreter.report(TCL_ERROR);
    Tcl_ResetResult(tcl);
  }
  return TCL_OK;
}

} // namespace

int makeTrusted(Interpreter& interpreter) {
  Tcl_Interp* tcl = interpreter.tcl();
  const XsScriptInfo& info = interpreter.info();
  if (initialize(tcl) != TCL_OK) return TCL_ERROR;
  Tcl_CreateObjCommand(tcl, "::xvrml::backgroundError", backgroundError, &interpreter, nullptr);
  for (const char* name : {"argv0", "argv"})
    Tcl_SetVar2Ex(tcl, name, nullptr, tclText(name[4] ? info.origin : "").get(), TCL_GLOBAL_ONLY);
  Tcl_SetVar2Ex(tcl, "argc", nullptr, Tcl_NewIntObj(0), TCL_GLOBAL_ONLY);
  const Object script[] = {Tcl_NewStringObj("info", -1), Tcl_NewStringObj("script", -1),
                           tclText(info.origin)};
  Tcl_Obj* words[] = {script[0].get(), script[1].get(), script[2].get()};
  if (Tcl_EvalObjv(tcl, 3, words, TCL_EVAL_GLOBAL) != TCL_OK) return TCL_ERROR;
  if (Tcl_Eval(tcl, "interp bgerror {} ::xvrml::backgroundError") != TCL_OK) return TCL_ERROR;
  return Tcl_Eval(tcl, prelude);
}

} // namespace tclscript
