# What tests run with: sanitizer_environment, and in an instrumented build sanitizer_preloaded, the runtimes that a
# program needs, as Python, that is not instrumented and loads a library that is. guarded_memory is a library, or empty.
set(sanitizer_environment)
set(sanitizer_preloaded)
if(PMDSIM_SANITIZE STREQUAL "address")
  add_library(keep_loaded MODULE ${CMAKE_CURRENT_LIST_DIR}/keep_loaded.cpp)
  # Leaks are looked for in every program; what others' libraries keep is in leaks.supp, one by one.
  list(APPEND sanitizer_environment
       ASAN_OPTIONS=detect_stack_use_after_return=1:strict_string_checks=1:check_initialization_order=1:strict_init_order=1:verify_asan_link_order=0:allocator_may_return_null=1
       LSAN_OPTIONS=suppressions=${CMAKE_CURRENT_LIST_DIR}/leaks.supp:print_suppressions=0
       UBSAN_OPTIONS=print_stacktrace=1
       LD_PRELOAD=$<TARGET_FILE:keep_loaded>)
  set(runtimes asan stdc++)
elseif(PMDSIM_SANITIZE STREQUAL "thread")
  # Embree and lavapipe's LLVM are not instrumented: what happens inside of them is not seen. TBB is, by
  # tbb_for_threads.sh.
  list(APPEND sanitizer_environment
       TSAN_OPTIONS=allocator_may_return_null=1:ignore_noninstrumented_modules=1:second_deadlock_stack=1:print_suppressions=0:suppressions=${CMAKE_CURRENT_LIST_DIR}/races.supp
       LD_LIBRARY_PATH=${PROJECT_BINARY_DIR}/tbb)
  set(runtimes tsan stdc++)
else()
  # What sanitizers do not see, as lavapipe's shaders are not instrumented.
  add_library(guarded_memory MODULE ${CMAKE_CURRENT_LIST_DIR}/guarded_memory.cpp)
  target_link_libraries(guarded_memory PRIVATE pmdsim_flags ${CMAKE_DL_LIBS})
  set(guarded_memory $<TARGET_FILE:guarded_memory>)
  list(APPEND sanitizer_environment LD_PRELOAD=${guarded_memory})
endif()
foreach(runtime IN LISTS runtimes)
  execute_process(COMMAND ${CMAKE_CXX_COMPILER} -print-file-name=lib${runtime}.so OUTPUT_VARIABLE file
                  OUTPUT_STRIP_TRAILING_WHITESPACE)
  list(APPEND sanitizer_preloaded ${file})
endforeach()
list(JOIN sanitizer_preloaded ":" sanitizer_preloaded)
