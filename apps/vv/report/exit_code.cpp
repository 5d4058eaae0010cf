#include "report/exit_code.h"

#include <exception>
#include <new>

#include "libpicture/files/picture.h"
#include "process/messages.h"
#include "shortage.h"

namespace vv {

namespace {

const char* optionOf(const picture::InputError& error, const Options* options) {
  if (!options) return "";
  return error.path == options->render.environment       ? "--environment: "
         : error.path == options->render.background.file ? "--background: "
                                                         : "";
}

int exitCodeOf(const picture::RenderError& error) {
  return error.code == RT_CLUSTER_ERROR   ? exitNoWorkers
         : error.code == RT_SUMS_ERROR    ? exitUsage
         : error.code == RT_OUT_OF_MEMORY ? exitTryAgain
                                          : exitRender;
}

} // namespace

int sayException(const Options* options) {
  try {
    throw;
  } catch (const UsageError& error) {
    sayError(error.what());
    return exitUsage;
  } catch (const Failure& failure) {
    sayError(failure.text);
    return failure.code;
  } catch (const xvrml::LoadError& error) {
    say(error.diagnostic.text());
    return exitInput;
  } catch (const picture::InputError& error) {
    sayError(optionOf(error, options) + std::string(error.what()));
    return exitInput;
  } catch (const picture::RenderError& error) {
    sayError(error.what());
    return exitCodeOf(error);
  } catch (const std::bad_alloc&) {
    sayError("out of memory");
    return exitTryAgain;
  } catch (const std::exception& error) {
    sayError(error.what());
    return isShortage(error) ? exitTryAgain : exitRender;
  }
}

} // namespace vv
