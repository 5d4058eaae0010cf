#pragma once
#include <cstdlib>
#include <string>
namespace picture::live {
struct Tune { float v[32]; bool set[32]; Tune(){ for(int k=0;k<32;k++){ const char*e=std::getenv(("T"+std::to_string(k)).c_str()); set[k]=e; v[k]=e?float(std::atof(e)):0; } } };
inline const Tune tuned;
inline float tune(int k,float d){ return tuned.set[k]?tuned.v[k]:d; }
}
